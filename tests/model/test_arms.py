"""The shipped arms are the machines that their sources describe."""

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from modelgen.description import Arm, DirectDrive, LeveredDrive, Scalar, geometry_symbol, load
from modelgen.effects import known_effects

Matrix = NDArray[np.float64]

COORDINATES = {
    "ariane4": 3,
    "ariane4_free": 4,
    "ariane6": 6,
    "gravity_arm": 2,
    "gravity_link1": 1,
    "gravity_link1_loaded": 1,
    "gravity_link2": 1,
    "rx90": 6,
    "puma560": 6,
    "ur10e": 6,
    "wam7": 7,
    "iiwa14": 7,
    "yaw3pitch": 4,
    "scara": 4,
    "screw_axis": 1,
    "two_fingers": 5,
}
BENCHMARKS = {"ur10e_bench": 6, "iiwa14_bench": 7}


@pytest.fixture(scope="module")
def arms(checkout: Path) -> dict[str, Arm]:
    return load(checkout / "arms.yaml", known_effects())


@pytest.fixture(scope="module")
def benchmarks(checkout: Path) -> dict[str, Arm]:
    return load(checkout / "benchmarks" / "arms.yaml", known_effects())


def rot_x(a: float) -> Matrix:
    return np.array(
        [[1, 0, 0, 0], [0, math.cos(a), -math.sin(a), 0], [0, math.sin(a), math.cos(a), 0], [0, 0, 0, 1]]
    )


def rot_z(a: float) -> Matrix:
    return np.array(
        [[math.cos(a), -math.sin(a), 0, 0], [math.sin(a), math.cos(a), 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    )


def move(x: float = 0.0, z: float = 0.0) -> Matrix:
    result = np.eye(4)
    result[0, 3], result[2, 3] = x, z
    return result


def value(arm: Arm, scalar: Scalar) -> float:
    if isinstance(scalar, float):
        return scalar
    return float(scalar.subs({geometry_symbol(name): x for name, x in arm.symbols.items()}))


def frames(arm: Arm, q: list[float]) -> list[Matrix]:
    """Frame of every link in the base, straight from the definition of the parameters."""
    coordinates = dict(zip(arm.coordinates, q, strict=True))
    result: dict[int, Matrix] = {}
    for i in arm.order:
        joint = arm.joints[i]
        a, d, r, th, g, b = (
            value(arm, x) for x in (joint.alpha, joint.d, joint.r, joint.theta, joint.gamma, joint.b)
        )
        angle = coordinates.get(i, joint.locked or 0.0)
        if joint.type == "revolute":
            th += angle
        elif joint.type == "prismatic":
            r += angle
        before = np.eye(4) if joint.antecedent is None else result[joint.antecedent]
        result[i] = before @ rot_z(g) @ move(z=b) @ rot_x(a) @ move(x=d) @ rot_z(th) @ move(z=r)
    return [result[i] for i in range(len(arm.joints))]


def standard_dh(rows: list[tuple[float, float, float]], q: list[float]) -> Matrix:
    """Last frame in the base from rows (a, alpha, d) in the classic convention: a and alpha come last."""
    result = np.eye(4)
    for (a, alpha, d), angle in zip(rows, q, strict=True):
        result = result @ rot_z(angle) @ move(z=d) @ move(x=a) @ rot_x(alpha)
    return result


def test_they_are_all_there_and_the_effects_are_in_the_catalogue(
    arms: dict[str, Arm], benchmarks: dict[str, Arm]
) -> None:
    assert {name: len(arm.coordinates) for name, arm in arms.items()} == COORDINATES
    assert {name: len(arm.coordinates) for name, arm in benchmarks.items()} == BENCHMARKS
    assert all(arm.notes == () for arm in (*arms.values(), *benchmarks.values()))


def test_only_the_arms_that_ship_are_in_the_folder_of_generated_code(checkout: Path) -> None:
    assert {path.name for path in (checkout / "generated").iterdir()} == set(COORDINATES)


def test_every_arm_names_its_source_and_can_be_simulated(
    arms: dict[str, Arm], benchmarks: dict[str, Arm]
) -> None:
    for arm in (*arms.values(), *benchmarks.values()):
        assert len(arm.source) > 20
        assert None not in arm.links


def test_what_no_source_gives_is_marked(checkout: Path) -> None:
    text = (checkout / "arms.yaml").read_text(encoding="utf-8")
    added = (checkout / "benchmarks" / "arms.yaml").read_text(encoding="utf-8").partition("arms:\n")[2]
    blocks = [*text.split("\n\n  "), *added.split("\n\n  ")]
    known = COORDINATES | BENCHMARKS
    assert len(blocks) == len(known)
    # The three repeat gravity_arm; all of the WAM is published.
    exact = {"gravity_link1", "gravity_link1_loaded", "gravity_link2", "wam7"}
    for block in blocks[1:]:
        name = block.split(":")[0].strip()
        assert name in known
        assert ("assumed" in block) is (name not in exact), name


def test_levers_of_the_four_joint_arm_give_the_printed_ranges_and_speeds(arms: dict[str, Arm]) -> None:
    """Leborne et al. 2018, Table III. The witness turns the joint and measures the actuator."""
    printed = {0: (-90, 32, 28.0), 1: (7, 94, 9.58), 2: (110, 244, 25.0)}
    for i, (low, high, speed) in printed.items():
        joint = arms["ariane4"].joints[i]
        drive = joint.drive
        assert isinstance(drive, LeveredDrive)
        assert joint.limits.position == pytest.approx((math.radians(low), math.radians(high)), abs=2e-4)
        q = np.radians(np.linspace(low, high, 20001))
        inner = (q - drive.offset) * drive.rev
        ends = np.stack([drive.l2 * np.cos(inner) - drive.l1, drive.l2 * np.sin(inner)])
        length = np.hypot(*ends)
        assert (length[0], length[-1]) == pytest.approx(drive.length, abs=2e-6)
        span = (drive.motor[1] - drive.motor[0]) / (drive.length[1] - drive.length[0])
        dq_m_dq = np.gradient(length, q) * span
        fastest = math.degrees(drive.limits.velocity / np.abs(dq_m_dq).min())
        assert fastest == pytest.approx(speed, abs=0.06)


def test_strokes_of_the_six_joint_arm_lie_about_the_right_angle(arms: dict[str, Arm]) -> None:
    levers = [joint.drive for joint in arms["ariane6"].joints if isinstance(joint.drive, LeveredDrive)]
    assert len(levers) == 4
    for drive in levers:
        middle = math.hypot(drive.l1, drive.l2)
        assert drive.length == pytest.approx((middle - 0.05, middle + 0.05), abs=6e-5)


def test_the_wam_is_barretts(arms: dict[str, Arm]) -> None:
    """User's Manual D1001, Table 5, in the classic convention."""
    quarter = math.pi / 2
    rows = [
        (0.0, -quarter, 0.0),
        (0.0, quarter, 0.0),
        (0.045, -quarter, 0.55),
        (-0.045, quarter, 0.0),
        (0.0, -quarter, 0.3),
        (0.0, quarter, 0.0),
        (0.0, 0.0, 0.06),
    ]
    for q in np.random.default_rng(1).uniform(-3, 3, (5, 7)).tolist():
        np.testing.assert_allclose(frames(arms["wam7"], q)[-1], standard_dh(rows, q), atol=1e-12)


def test_the_ur10e_is_universal_robots(arms: dict[str, Arm]) -> None:
    """The maker's parameters for kinematics and dynamics, in the classic convention."""
    quarter = math.pi / 2
    rows = [
        (0.0, quarter, 0.1807),
        (-0.6127, 0.0, 0.0),
        (-0.57155, 0.0, 0.0),
        (0.0, quarter, 0.17415),
        (0.0, -quarter, 0.11985),
        (0.0, 0.0, 0.11655),
    ]
    centres = [(0.021, 0, 0.027), (0.38, 0, 0.158), (0.24, 0, 0.068), (0, 0.007, 0.018), (0, 0.007, 0.018)]
    arm = arms["ur10e"]
    for q in np.random.default_rng(2).uniform(-3, 3, (5, 6)).tolist():
        ours = frames(arm, q)
        np.testing.assert_allclose(ours[-1], standard_dh(rows, q), atol=1e-12)
        for i, centre in enumerate(centres):
            link = arm.links[i]
            assert link is not None
            theirs = standard_dh(rows[: i + 1], q[: i + 1]) @ np.array([*centre, 1.0])
            np.testing.assert_allclose(ours[i] @ np.array([*link.com, 1.0]), theirs, atol=1e-12)


def test_the_iiwa_stands_upright_and_reaches_as_far_as_its_data_sheet_says(arms: dict[str, Arm]) -> None:
    """360 + 420 + 400 + 126 mm; the reach of 820 mm is from the shoulder to the wrist."""
    arm = arms["iiwa14"]
    upright = frames(arm, [0.0] * 7)
    np.testing.assert_allclose(upright[-1][:3, 3], [0, 0, 1.306], atol=1e-12)
    np.testing.assert_allclose(upright[-1][:3, :3], np.eye(3), atol=1e-12)
    for i in range(7):
        link = arm.links[i]
        assert link is not None
        height = (upright[i] @ np.array([*link.com, 1.0]))[2]
        assert 0.1 < height < 1.31
    level = frames(arm, [0.3, math.pi / 2, 0.7, 0, 0, 0, 0])
    assert np.hypot(*level[5][:2, 3]) == pytest.approx(0.82)


def test_the_puma_is_armstrongs_turned_into_craigs_frames(arms: dict[str, Arm]) -> None:
    """Centres of mass from Armstrong, Khatib, Burdick 1986 in their own frames.

    Their third frame is turned by half a turn. Between the two sources link lengths differ by up to 2 mm and
    the offset between the planes of the links by 25 mm.
    """
    rows = [
        (0.0, 0.0, 0.0),
        (-90, 0.0, 0.2435),
        (0, 0.4318, -0.0934),
        (90, -0.0203, 0.4331),
        (-90, 0, 0),
        (90, 0, 0),
    ]
    centres = [None, (0.068, 0.006, -0.016), (0, -0.070, 0.014), (0, 0, -0.019), (0, 0, 0), (0, 0, 0.032)]
    arm = arms["puma560"]
    q = [0.3, -0.7, 0.9, 0.4, -1.1, 0.6]
    theirs = np.eye(4)
    ours = frames(arm, q)
    for i, ((alpha, a, d), centre) in enumerate(zip(rows, centres, strict=True)):
        turn = math.pi if i == 2 else 0.0
        theirs = theirs @ rot_x(math.radians(alpha)) @ move(x=a) @ rot_z(q[i] + turn) @ move(z=d)
        link = arm.links[i]
        assert link is not None
        if centre is not None:
            gap = ours[i] @ np.array([*link.com, 1.0]) - theirs @ np.array([*centre, 1.0])
            assert np.linalg.norm(gap) < 0.03, i


def test_the_gravity_arm_hangs_at_zero(arms: dict[str, Arm]) -> None:
    """Potential energy has its minimum at q = 0, and its curvature is that of the printed figures."""

    def potential(arm: Arm, q: list[float]) -> float:
        g = np.array(arm.gravity)
        return -sum(
            link.mass * float(g @ (frame @ np.array([*link.com, 1.0]))[:3])
            for link, frame in zip(arm.links, frames(arm, q), strict=True)
            if link is not None
        )

    m1, c1, l1, m2, c2 = 8.866883, 0.374094, 0.538534, 6.743220, 0.193949
    stiffness = {
        "gravity_link1": m1 * c1 * 9.81,
        "gravity_link1_loaded": (m1 * c1 + m2 * (l1 + c2)) * 9.81,
        "gravity_link2": m2 * c2 * 9.81,
    }
    for name, expected in stiffness.items():
        arm = arms[name]
        middle, up, down = (potential(arm, [q]) for q in (0.0, 1e-3, -1e-3))
        assert (up + down - 2 * middle) / 1e-6 == pytest.approx(expected, rel=1e-6)
        assert up == pytest.approx(down, rel=1e-12)
    both = arms["gravity_arm"]
    assert potential(both, [0.1, -0.2]) > potential(both, [0.0, 0.0])
    assert potential(both, [0.0, 0.0]) == pytest.approx(-9.81 * (m1 * c1 + m2 * (l1 + c2)))


def test_friction_of_the_gravity_arm(arms: dict[str, Arm]) -> None:
    """Table 2; the links alone have the friction of their own joint."""
    first, second = (
        {use.name: dict(use.values) for use in joint.effects} for joint in arms["gravity_arm"].joints
    )
    assert first == {
        "viscous_friction": {"coefficient": 0.725102},
        "coulomb_friction": {"magnitude": 0.183334},
    }
    assert second == {
        "viscous_friction": {"coefficient": 0.235819},
        "coulomb_friction": {"magnitude": 0.187307},
    }
    assert arms["gravity_link1"].joints[0].effects == arms["gravity_arm"].joints[0].effects
    assert arms["gravity_link2"].joints[0].effects == arms["gravity_arm"].joints[1].effects
    loaded = arms["gravity_link1_loaded"]
    assert loaded.joints[1].locked == 0.0
    assert loaded.links == arms["gravity_arm"].links


def test_the_two_ariane_arms_with_four_joints_differ_in_the_lock_alone(arms: dict[str, Arm]) -> None:
    locked, free = arms["ariane4"], arms["ariane4_free"]
    assert locked.joints[:3] == free.joints[:3]
    assert (locked.joints[3].locked, free.joints[3].locked) == (0.0, None)
    assert locked.joints[3].drive == free.joints[3].drive
    assert locked.links == free.links


def test_the_screw_moves_a_lead_per_turn_and_rubs_as_published(arms: dict[str, Arm]) -> None:
    joint = arms["screw_axis"].joints[0]
    drive = joint.drive
    assert isinstance(drive, DirectDrive)
    assert 2 * math.pi / drive.ratio == pytest.approx(0.005)
    values = {use.name: dict(use.values) for use in joint.effects}
    # Power at the carriage and at the motor are the same: F v = T w with w = ratio v.
    assert values["viscous_friction"]["coefficient"] * drive.ratio**2 == pytest.approx(203.5)
    assert values["coulomb_friction"]["magnitude"] * drive.ratio == pytest.approx(20.4)
    axis = frames(arms["screw_axis"], [0.0])[0][:3, 2]
    assert axis @ np.array(arms["screw_axis"].gravity) == pytest.approx(0.0, abs=1e-12)


def test_the_scara_lowers_its_tool_straight_down(arms: dict[str, Arm]) -> None:
    arm = arms["scara"]
    up, down = (frames(arm, [0.4, -0.9, q, 0.2])[-1] for q in (0.0, 0.1))
    np.testing.assert_allclose(down[:3, 3] - up[:3, 3], [0, 0, -0.1], atol=1e-12)
    np.testing.assert_allclose(down[:3, :3], up[:3, :3], atol=1e-12)


def test_the_fingers_stand_on_one_wrist(arms: dict[str, Arm]) -> None:
    arm = arms["two_fingers"]
    assert [joint.antecedent for joint in arm.joints] == [None, 0, 1, 0, 3]
    still, turned = frames(arm, [0, 0, 0, 0, 0]), frames(arm, [0, 0.5, 0.5, 0, 0])
    np.testing.assert_allclose(still[4], turned[4])  # one finger does not move the other
    assert np.linalg.norm(still[2][:3, 3] - turned[2][:3, 3]) > 0.01
