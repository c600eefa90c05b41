"""Drives: motor coordinates, gains and ranges against the points of the mechanism."""

import math

import numpy as np
import pytest
import sympy as sp
from witness.arms import Emitted, build
from witness.compare import agree
from witness.levers import Drive

from modelgen.description import Arm, DirectDrive, EffectUse, Joint, LeveredDrive, NoDrive
from modelgen.description import Drive as Description
from modelgen.functions import STATUS_STROKE, Options
from modelgen.transmission import of_joint

L1, L2 = 0.32, 0.07


def lever(rev: int, motor: tuple[float, float], l1: float = L1, l2: float = L2) -> LeveredDrive:
    ends = [math.sqrt(l1**2 + l2**2 - 2 * l1 * l2 * math.cos(math.radians(a))) for a in (25, 150)]
    return LeveredDrive(l1, l2, (ends[0], ends[1]), motor, rev, -1.1, 4e-3)


DRIVES: dict[str, Description] = {
    "rev+1": lever(1, (0.0, 20850.0)),
    "rev-1": lever(-1, (0.0, 20850.0)),
    "counts down": lever(1, (26750.0, 300.0)),
    "rev-1 counts down": lever(-1, (5.0, -12.0)),
    "short side first": lever(-1, (0.0, 1.0), l1=0.07, l2=0.32),
    "gear": DirectDrive(-62.6111, 0.23),
    "none": NoDrive(),
}
LEVERS = {name: drive for name, drive in DRIVES.items() if isinstance(drive, LeveredDrive)}
each_drive = pytest.mark.parametrize("name", DRIVES)
each_lever = pytest.mark.parametrize("name", LEVERS)


def built(name: str) -> tuple[Emitted, Drive]:
    """One joint with the drive, its functions and its witness."""
    effects = (EffectUse("viscous_friction"), EffectUse("drive_inertia"))
    arm = Arm(
        "one", (Joint("j1", "revolute", drive=DRIVES[name], effects=effects),), (None,), (3.0, 9.0, 1.0)
    )
    return build(arm, Options()), Drive(arm, 0)


def inside(witness: Drive, samples: int = 40) -> np.ndarray:
    low, high = witness.span() or (-3.0, 3.0)
    return np.linspace(low + 1e-3, high - 1e-3, samples)[:, None]


def rates() -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(0)
    return rng.uniform(-2, 2, (40, 1)), rng.uniform(-5, 5, (40, 1))


@each_drive
def test_motor_coordinates_by_the_points_of_the_mechanism(name: str) -> None:
    emitted, witness = built(name)
    q, (dq, ddq) = inside(witness), rates()
    found = emitted("motor_from_joint", q, dq, ddq)
    agree(found[0], witness.motor(q))
    agree(found[1], witness.k1(q) * dq)
    agree(found[2], witness.k1(q) * ddq + witness.slope(q) * dq**2)


@each_drive
def test_velocity_and_acceleration_are_derivatives_of_the_position(name: str) -> None:
    """Central differences of the emitted motor coordinate along a motion."""
    emitted, witness = built(name)
    q, (dq, ddq) = inside(witness, 42)[1:-1], rates()
    h = 1e-4

    def motor(t: float) -> np.ndarray:
        at = q + dq * t + ddq * t * t / 2
        return np.asarray(emitted("motor_from_joint", at, dq, ddq)[0])

    _, speed, acceleration = emitted("motor_from_joint", q, dq, ddq)
    agree((motor(h) - motor(-h)) / (2 * h), speed, 1e-6)
    agree((motor(h) - 2 * motor(0) + motor(-h)) / h**2 + 1e3 * speed, acceleration + 1e3 * speed, 1e-5)


@each_drive
def test_there_and_back(name: str) -> None:
    emitted, witness = built(name)
    q, (dq, ddq) = inside(witness), rates()
    back = emitted("joint_from_motor", *emitted("motor_from_joint", q, dq, ddq))
    for there, here in zip((q, dq, ddq), back, strict=True):
        agree(here, there, 1e-11)


@each_drive
def test_gain_by_virtual_work(name: str) -> None:
    """The current's power at the motor coordinate is the effort's at the joint."""
    emitted, witness = built(name)
    q, (dq, ddq) = inside(witness), rates()
    gain = emitted("drive_gain", q)
    _, speed, _ = emitted("motor_from_joint", q, dq, ddq)
    agree(gain * dq, witness.constant * speed, 1e-12)
    agree(gain, witness.gain(q), 1e-12)


@each_lever
def test_ranges_by_the_sides_of_the_triangle(name: str) -> None:
    emitted, witness = built(name)
    low, high = witness.span() or (0.0, 0.0)
    transmission = of_joint(emitted.arm, emitted.arm.joints[0])
    assert transmission.joint_range() == pytest.approx((low, high), abs=1e-12)
    assert transmission.motor_range() == (min(LEVERS[name].motor), max(LEVERS[name].motor))
    for function in ("inverse_dynamics", "drive_gain", "forward_dynamics", "regressor"):
        (found,) = emitted.functions[function].ranges
        assert found.status == STATUS_STROKE
        assert math.radians(0.01) < low - found.low < math.radians(0.1)
        assert math.radians(0.01) < found.high - high < math.radians(0.1)
    (back,) = emitted.functions["joint_from_motor"].ranges
    span = abs(LEVERS[name].motor[1] - LEVERS[name].motor[0])
    assert min(LEVERS[name].motor) - back.low == pytest.approx(1e-3 * span)
    for function in ("forward_kinematics", "jacobian"):  # these know nothing of drives
        assert emitted.functions[function].ranges == ()


@each_lever
def test_branches_are_mirror_images(name: str) -> None:
    """rev turns the joint about its offset: q_m is even in q - offset, k1 odd."""
    drive = LEVERS[name]
    emitted, witness = built(name)
    q = inside(witness)
    mirrored = 2 * drive.offset - q
    one = np.ones_like(q)
    here = emitted("motor_from_joint", q, one, 0 * one)
    there = emitted("motor_from_joint", mirrored, one, 0 * one)
    agree(there[0], here[0], 1e-12)
    agree(there[1], -here[1], 1e-12)
    agree(there[2], here[2], 1e-12)


@each_lever
def test_gain_vanishes_at_the_dead_centres_only(name: str) -> None:
    drive = LEVERS[name]
    emitted, witness = built(name)
    assert np.abs(emitted("drive_gain", inside(witness))).min() > 0
    largest = np.abs(emitted("drive_gain", inside(witness))).max()
    for inner in (0.0, math.pi):
        dead = np.array([drive.offset + drive.rev * inner])
        assert abs(emitted("drive_gain", dead)[0]) < 1e-12 * largest


def test_a_screw_of_twice_the_lead_moves_twice_as_far() -> None:
    """q_m = ratio q with ratio = 2 pi / lead on a sliding joint."""
    for lead in (0.005, 0.01):
        drive = DirectDrive(2 * sp.pi / sp.Float(lead), 0.03)
        emitted = build(Arm("screw", (Joint("j1", "prismatic", drive=drive),), (None,)), Options())
        turned = emitted("joint_from_motor", [2 * math.pi], [4 * math.pi], [0.0])
        assert (turned[0][0], turned[1][0]) == pytest.approx((lead, 2 * lead), rel=1e-14)
        # effort in N: power of 1 A at 1 rad/s over the speed that this is
        assert emitted("drive_gain", [0.0])[0] == pytest.approx(0.03 * 2 * math.pi / lead)


# unit -> exponents of kg, m, s, A and of the motor's own unit
BASE = {
    "kg": (1, 0, 0, 0, 0),
    "m": (0, 1, 0, 0, 0),
    "s": (0, 0, 1, 0, 0),
    "A": (0, 0, 0, 1, 0),
    "unit": (0, 0, 0, 0, 1),
    "rad": (0, 0, 0, 0, 0),
    "N": (1, 1, -2, 0, 0),
    "J": (1, 2, -2, 0, 0),
    "1": (0, 0, 0, 0, 0),
}


def dimension(unit: str) -> tuple[int, ...]:
    """Exponents of a unit such as "N m s^2/rad" or "J s/unit^2"."""
    total = np.zeros(5, dtype=int)
    for sign, part in zip((1, -1), (*unit.split("/"), "1")[:2], strict=True):
        for factor in part.split():
            name, _, power = factor.partition("^")
            total += sign * int(power or 1) * np.array(BASE[name])
    return tuple(int(x) for x in total)


@pytest.mark.parametrize("name", ["rev+1", "gear", "none"])
def test_dimensions(name: str) -> None:
    """A parameter times its column is an energy over the motor coordinate, whatever unit that has."""
    emitted, _ = built(name)
    coordinate = {"rev+1": "unit", "gear": "rad", "none": "rad"}[name]
    x = np.array(dimension(coordinate))
    force = np.array(dimension("J")) - x
    second = np.array(dimension("s"))
    units = {p.name: np.array(dimension(p.unit)) for p in emitted.model.standard}
    np.testing.assert_array_equal(units["FV1"] + x - second, force)
    np.testing.assert_array_equal(units["IA1"] + x - 2 * second, force)
    # links: torque = inertia / s^2 = moment times gravity = mass times length times gravity
    torque = np.array(dimension("N m"))
    np.testing.assert_array_equal(units["ZZ1"] - 2 * second, torque)
    np.testing.assert_array_equal(units["MX1"] + dimension("m") - 2 * second, torque)
    np.testing.assert_array_equal(units["M1"] + 2 * np.array(dimension("m")) - 2 * second, torque)


def test_dimensions_in_a_fluid() -> None:
    """Density times gravity times a first moment of volume is a torque, times a volume a force."""
    arm = Arm("one", (Joint("j1", "revolute"),), (None,), (3.0, 9.0, 1.0), fluid_density=1000.0)
    units = {p.name: np.array(dimension(p.unit)) for p in build(arm).model.standard}
    weight = (
        np.array(dimension("kg"))
        - 3 * np.array(dimension("m"))
        + dimension("m")
        - 2 * np.array(dimension("s"))
    )
    for axis in "XYZ":
        np.testing.assert_array_equal(units[f"V{axis}1"] + weight, dimension("N m"))
    np.testing.assert_array_equal(units["V1"] + weight, dimension("N"))
