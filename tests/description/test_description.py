"""What a description means: defaults, units, levers, symbols, trees."""

import copy
import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from modelgen.description import (
    DEFAULT_EFFECTS,
    DirectDrive,
    LeveredDrive,
    NoDrive,
    geometry_symbol,
    load,
    loads,
    starter,
)
from modelgen.description.names import C_KEYWORDS
from modelgen.effects import known_effects
from modelgen.errors import InputError

HEAD = "schema: 1\nconvention: khalil_kleinfinger\narms:\n  a:\n"


def arm_of(body: str):  # noqa: ANN201
    """The arm described by flow-style YAML lines below its name."""
    return loads(HEAD + "".join(f"    {line}\n" for line in body.splitlines()))["a"]


def levered(limits: str = "{}", rev: int = 1, length: str = "[0.27, 0.36]", offset: str = "-60 deg") -> str:
    return (
        f"joints: [{{name: j1, limits: {limits}, drive: {{type: levered, l1: 0.32, l2: 0.06, "
        f"length: {length}, motor: [20000, 0], rev: {rev}, offset: {offset}, torque_constant: 1.0e-4}}}}]"
    )


def test_what_is_not_given() -> None:
    arm = arm_of("joints: [{name: j1}]")
    (joint,) = arm.joints
    assert (joint.type, joint.alpha, joint.d, joint.r, joint.theta) == ("revolute", 0.0, 0.0, 0.0, 0.0)
    assert (joint.gamma, joint.b, joint.antecedent, joint.locked) == (0.0, 0.0, None, None)
    assert joint.drive == NoDrive()
    assert joint.effects == ()
    assert arm.gravity == (0.0, 0.0, -9.81)
    assert (arm.fluid_density, arm.links, arm.symbols) == (0.0, (None,), {})


def test_values_are_plain_numbers_in_si_units() -> None:
    arm = arm_of(
        "joints:\n"
        "  - {name: j1, alpha: 90 deg, d: 116 mm, limits: {position: [-90 deg, 32 deg], velocity: 28 deg,\n"
        "     acceleration: 4, effort: 5}, drive: {type: direct, ratio: -100, torque_constant: 0.05,\n"
        "     motor_velocity: 300, motor_acceleration: 3000, current: 4}}\n"
        "  - {name: j2, type: prismatic, limits: {position: [0, 5 cm], velocity: 20 mm}}"
    )
    first, second = arm.joints
    assert first.alpha == pytest.approx(math.pi / 2)
    assert first.d == pytest.approx(0.116)
    assert first.limits.position == pytest.approx((math.radians(-90), math.radians(32)))
    assert first.limits.velocity == pytest.approx(math.radians(28))
    assert (first.limits.acceleration, first.limits.effort) == (4.0, 5.0)
    assert isinstance(first.drive, DirectDrive)
    assert (first.drive.ratio, first.drive.torque_constant) == (-100.0, 0.05)
    assert dataclasses.astuple(first.drive.limits) == (300.0, 3000.0, 4.0)
    assert all(type(value) is float for value in (first.alpha, first.d, first.r, first.drive.ratio))
    assert second.limits.position == pytest.approx((0.0, 0.05))
    assert second.limits.velocity == pytest.approx(0.02)


def test_a_driven_joint_has_the_default_effects_and_an_undriven_one_none() -> None:
    arm = arm_of(
        "joints:\n"
        "  - {name: a, drive: {type: direct, ratio: 1, torque_constant: 1}}\n"
        "  - {name: b, drive: {type: none}}\n"
        "  - {name: c, drive: {type: direct, ratio: 1, torque_constant: 1}, effects: []}\n"
        "  - {name: d, effects: [spring, coulomb_friction: {magnitude: 3/4}]}"
    )
    names = [[use.name for use in joint.effects] for joint in arm.joints]
    assert names == [list(DEFAULT_EFFECTS), [], [], ["spring", "coulomb_friction"]]
    assert DEFAULT_EFFECTS == ("viscous_friction", "coulomb_friction", "drive_inertia")
    assert arm.joints[3].effects[1].values == {"magnitude": 0.75}


def test_a_locked_joint_leaves_the_coordinates_with_its_effects_but_keeps_its_link() -> None:
    drive = "drive: {type: direct, ratio: 1, torque_constant: 1}"
    arm = arm_of(
        "locked: {b: 30 deg}\n"
        f"joints: [{{name: a, {drive}}}, {{name: b, {drive}}},\n"
        f"  {{name: t, type: fixed}}, {{name: c, {drive}}}]\n"
        "links: {b: {mass: 1, com: [0, 0, 1 cm], inertia: [1, 0, 0, 1, 0, 1]}}"
    )
    assert arm.coordinates == (0, 3)
    assert arm.joints[1].locked == pytest.approx(math.pi / 6)
    assert arm.joints[1].effects == ()
    assert arm.links[0] is None
    assert arm.links[1] is not None
    assert arm.links[1].com == (0.0, 0.0, 0.01)


def test_a_tree_in_any_order() -> None:
    arm = arm_of(
        "joints:\n"
        "  - {name: tip, antecedent: hand}\n"
        "  - {name: hand, antecedent: base, gamma: 30 deg, b: 0.1}\n"
        "  - {name: thumb, antecedent: hand}\n"
        "  - {name: nail}"
    )
    assert [joint.antecedent for joint in arm.joints] == [1, None, 1, 2]
    assert arm.order.index(1) < arm.order.index(0)
    assert (arm.joints[1].gamma, arm.joints[1].b) == (pytest.approx(math.pi / 6), 0.1)


def test_symbols_keep_their_names_in_the_geometry_and_are_numbers_elsewhere() -> None:
    arm = arm_of(
        "symbols: {d3: 443 mm, lead: 0.005}\n"
        "joints:\n"
        "  - {name: a, d: d3, r: -d3/2, limits: {position: [-d3, d3]}}\n"
        "  - {name: b, type: prismatic, drive: {type: direct, ratio: 2*pi/lead, torque_constant: 2*lead}}"
    )
    d3, lead = geometry_symbol("d3"), geometry_symbol("lead")
    assert arm.symbols == {"d3": pytest.approx(0.443), "lead": 0.005}
    assert arm.joints[0].d == d3
    assert arm.joints[0].r == -d3 / 2
    assert arm.joints[0].limits.position == pytest.approx((-0.443, 0.443))
    drive = arm.joints[1].drive
    assert isinstance(drive, DirectDrive)
    assert drive.ratio.free_symbols == {lead}
    assert float(drive.ratio.subs(lead, 0.005)) == pytest.approx(400 * math.pi)
    assert drive.torque_constant == 0.01


@pytest.mark.parametrize("rev", [1, -1])
def test_without_a_joint_range_the_stroke_gives_it(rev: int) -> None:
    """Witness: the two ends of the actuator as points of the plane, their distance the actuator's length."""
    arm = arm_of(levered(rev=rev, offset="-60 deg"))
    drive, limits = arm.joints[0].drive, arm.joints[0].limits
    assert isinstance(drive, LeveredDrive)
    assert limits.position is not None
    assert limits.position[0] < limits.position[1]
    lengths = []
    for q in limits.position:
        inner = (q - math.radians(-60)) * rev
        assert 0 < inner < math.pi
        end = np.array([0.06 * math.cos(inner), 0.06 * math.sin(inner)])
        lengths.append(float(np.linalg.norm(end - np.array([0.32, 0.0]))))
    assert sorted(lengths) == pytest.approx([0.27, 0.36], rel=1e-12)
    assert drive.motor == (20000.0, 0.0)


def test_a_range_a_little_beyond_the_stroke_is_cut_with_a_note() -> None:
    stroke = arm_of(levered()).joints[0].limits.position
    assert stroke is not None
    low, high = (math.degrees(end) for end in stroke)
    arm = arm_of(levered(f"{{position: [{low - 0.4} deg, {high - 5} deg]}}"))
    assert arm.joints[0].limits.position == pytest.approx((stroke[0], stroke[1] - math.radians(5)))
    assert len(arm.notes) == 1
    assert arm.notes[0].startswith("j1: the joint range ")
    with pytest.raises(InputError, match="but the actuator's stroke allows"):
        arm_of(levered(f"{{position: [{low - 0.6} deg, {high - 5} deg]}}"))


def test_a_range_within_the_stroke_is_kept_without_a_note() -> None:
    arm = arm_of(levered("{position: [-10 deg, 20 deg]}"))
    assert arm.joints[0].limits.position == pytest.approx((math.radians(-10), math.radians(20)))
    assert arm.notes == ()


@given(st.lists(st.tuples(*[st.floats(-1, 1)] * 3, st.floats(0.01, 5)), min_size=1, max_size=6))
def test_every_cloud_of_masses_is_a_body(points: list[tuple[float, float, float, float]]) -> None:
    """Any set of point masses is physical, however degenerate (a point, a rod, a plate)."""
    xyz, m = np.array([p[:3] for p in points]), np.array([p[3] for p in points])
    com = m @ xyz / m.sum()
    r = xyz - com
    inertia = np.einsum("k,kij->ij", m, np.einsum("kl,kl->k", r, r)[:, None, None] * np.eye(3))
    inertia -= np.einsum("k,ki,kj->ij", m, r, r)
    six = [float(inertia[i, j]) for i, j in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))]
    arm = arm_of(
        f"joints: [{{name: j1}}]\nlinks: {{j1: {{mass: {m.sum()}, com: {com.tolist()}, inertia: {six}}}}}"
    )
    assert arm.links[0] is not None
    assert arm.links[0].inertia == tuple(six)


def test_a_link_without_mass_has_no_inertia() -> None:
    arm = arm_of("joints: [{name: j1}]\nlinks: {j1: {mass: 0, com: [0, 0, 0], inertia: [0, 0, 0, 0, 0, 0]}}")
    assert arm.links[0] is not None
    assert arm.links[0].mass == 0.0


def test_objects_do_not_change() -> None:
    arm = arm_of("symbols: {d3: 1}\njoints: [{name: j1, effects: [coulomb_friction: {magnitude: 1}]}]")
    with pytest.raises(dataclasses.FrozenInstanceError):
        arm.name = "b"
    with pytest.raises(TypeError):
        arm.symbols["d3"] = 2.0
    with pytest.raises(TypeError):
        arm.joints[0].effects[0].values["magnitude"] = 2.0


def test_the_same_text_gives_the_same_arm_wherever_its_lines_are(checkout: Path) -> None:
    text = (checkout / "arms.yaml").read_text(encoding="utf-8")
    moved = loads("# a line more\n" + text, "elsewhere.yaml")
    assert moved == load(checkout / "arms.yaml")


@pytest.mark.parametrize("name", ["my_arm", "A", "arm2", "null", "Off", "x" * 48])
def test_the_starter_file_loads_as_it_stands(name: str) -> None:
    arms = loads(starter(name), "arms.yaml", known_effects())
    assert arms[name].source == ""  # an example has none
    assert list(arms) == [name]
    arm = arms[name]
    assert arm.notes == ()
    assert [type(joint.drive) for joint in arm.joints] == [LeveredDrive, DirectDrive]
    assert arm.joints[1].d == geometry_symbol("d2")
    assert None not in arm.links


@pytest.mark.parametrize("name", ["", "7", "a b", "a: b", "é", "int", "class", "x" * 49, "a\n"])
def test_no_starter_file_for_what_cannot_be_a_name(name: str) -> None:
    with pytest.raises(InputError, match=r"the arm name .* cannot be used"):
        starter(name)


def test_the_keywords_are_those_of_c99_and_cpp() -> None:
    assert {"int", "restrict", "inline", "class", "constexpr", "xor_eq", "co_await"} <= C_KEYWORDS
    assert not {"arm", "main", "printf"} & C_KEYWORDS


def test_an_arm_can_be_copied() -> None:
    arm = arm_of("joints: [{name: j1}]")
    assert dataclasses.replace(arm, name="b").name == "b"
    assert copy.copy(arm) == arm
