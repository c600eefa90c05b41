"""Links, drives, effects and buoyancy together, against a regressor put together anew.

Efforts of the links come from Pinocchio, motor coordinates from the points of each mechanism, effects
from their textbook laws. Base parameters are held against standard ones on the way.
"""

from collections.abc import Callable

import numpy as np
import pytest
from witness.arms import DRESSED_SEEDS, RANDOM, SHIPPED, Emitted, random_arm
from witness.bodies import random_bodies
from witness.compare import agree
from witness.mechanism import Mechanism, states

from modelgen.description import DirectDrive, LeveredDrive, NoDrive

SAMPLES = 6
each_arm = pytest.mark.parametrize("make", [*SHIPPED, *RANDOM])


class Case:
    """One arm with random parameters at random states; `inputs` by the witness."""

    def __init__(self, make: Callable[[], Emitted]) -> None:
        self.emitted = make()
        self.mechanism = Mechanism(self.emitted.arm)
        rng = np.random.default_rng(11)
        self.standard = self.mechanism.standard(random_bodies(self.emitted.arm, rng), rng)
        self.base = self.emitted.base(self.standard)
        self.state = states(self.emitted.arm, SAMPLES)
        self.columns = self.mechanism.regressor(*self.state)
        self.inputs = self.columns @ self.standard

    def both(self) -> tuple[tuple[str, np.ndarray], ...]:
        """Suffix and parameters of the two ways of giving them."""
        return ("", self.base), ("_standard", self.standard)


@each_arm
def test_standard_parameters_are_named_as_promised(make: Callable[[], Emitted]) -> None:
    emitted = make()
    assert [p.name for p in emitted.model.standard] == Mechanism(emitted.arm).names()


@each_arm
def test_standard_regressor(make: Callable[[], Emitted]) -> None:
    case = Case(make)
    found = case.emitted("regressor_standard", *case.state)
    agree(found, case.columns)
    # joint by joint too: the inputs of a levered joint and of an undriven one differ by orders of magnitude
    for n in range(found.shape[1]):
        agree(found[:, n], case.columns[:, n])


@each_arm
def test_regressors_times_parameters(make: Callable[[], Emitted]) -> None:
    case = Case(make)
    agree(case.emitted("regressor", *case.state) @ case.base, case.inputs)
    agree(case.emitted("regressor_standard", *case.state) @ case.standard, case.inputs)


@each_arm
def test_packed_regressor_and_its_table_are_the_regressor(make: Callable[[], Emitted]) -> None:
    case = Case(make)
    full = case.emitted("regressor", *case.state)
    table = case.emitted.model.packed
    spread = np.zeros_like(full)
    packed = case.emitted("regressor_packed", *case.state)[:, :, 0]
    spread[:, table.rows, table.columns] = packed
    np.testing.assert_allclose(spread, full, rtol=1e-10, atol=1e-12 * np.abs(full).max())
    # nothing in it is zero at every state: the table has no superfluous place
    assert np.abs(packed).max(axis=0).min() > 0
    assert len(set(zip(table.rows, table.columns, strict=True))) == len(table.rows)
    assert list(zip(table.rows, table.columns, strict=True)) == sorted(
        zip(table.rows, table.columns, strict=True)
    )


@each_arm
def test_inverse_dynamics_gravity_and_bias(make: Callable[[], Emitted]) -> None:
    case = Case(make)
    q, dq, _ = case.state
    rest = case.mechanism.regressor(q, 0 * q, 0 * q) @ case.standard
    moving = case.mechanism.regressor(q, dq, 0 * q) @ case.standard
    for suffix, parameters in case.both():
        agree(case.emitted(f"inverse_dynamics{suffix}", *case.state, parameters), case.inputs)
        # beside the whole input, since gravity may be nothing
        agree(case.emitted(f"gravity{suffix}", q, parameters) + case.inputs, rest + case.inputs)
        agree(case.emitted(f"bias{suffix}", q, dq, parameters) + case.inputs, moving + case.inputs)


@each_arm
def test_forward_dynamics_undoes_the_witness(make: Callable[[], Emitted]) -> None:
    case = Case(make)
    q, dq, ddq = case.state
    for suffix, parameters in case.both():
        agree(case.emitted(f"forward_dynamics{suffix}", q, dq, case.inputs, parameters), ddq)


@each_arm
def test_mass_matrix_is_the_change_of_effort_with_acceleration(make: Callable[[], Emitted]) -> None:
    """Efforts are linear in ddq: one difference is exact."""
    case = Case(make)
    q, dq, _ = case.state
    n = q.shape[1]
    gains = case.mechanism.gains(q)
    base = case.mechanism.regressor(q, dq, 0 * q) @ case.standard
    columns = [
        (case.mechanism.regressor(q, dq, 0 * q + unit) @ case.standard - base) * gains for unit in np.eye(n)
    ]
    mass = np.stack(columns, axis=2)
    for suffix, parameters in case.both():
        found = case.emitted(f"mass_matrix{suffix}", q, parameters)
        agree(found, mass)
        np.testing.assert_array_equal(found, np.swapaxes(found, 1, 2))
        assert np.linalg.eigvalsh(found).min() > 0


@each_arm
def test_base_and_standard_parameters_give_the_same_energy_changes(make: Callable[[], Emitted]) -> None:
    case = Case(make)
    q, dq, _ = case.state
    kinetic, potential = case.emitted("energy", q, dq, case.base)
    kinetic_standard, potential_standard = case.emitted("energy_standard", q, dq, case.standard)
    # what base parameters leave out may only be a constant
    agree(kinetic, kinetic_standard)
    shift = potential - potential_standard
    metre = 9.81 * sum(v for k, v in zip(case.mechanism.names(), case.standard, strict=True) if k[:2] == "M1")
    assert np.ptp(shift) <= 1e-10 * (np.abs(potential_standard).max() + metre)


@each_arm
def test_power_balance(make: Callable[[], Emitted]) -> None:
    """dE/dt = K i dq - power of friction, with dE/dt by differences along the motion."""
    case = Case(make)
    names = case.mechanism.names()
    q, dq, ddq = case.state
    lost = np.array([name[:2] in ("FV", "FC", "FS") for name in names])
    friction = case.columns @ np.where(lost, case.standard, 0.0)
    power = np.sum(case.mechanism.gains(q) * (case.inputs - friction) * dq, axis=1)

    def energy(t: float) -> np.ndarray:
        at, speed = q + dq * t + ddq * t * t / 2, dq + ddq * t
        kinetic, potential = case.emitted("energy", at, speed, case.base)
        return (kinetic + potential)[:, 0]

    h = 1e-3
    change = sum(c * (energy(k * h) - energy(-k * h)) for k, c in ((1, 3 / 4), (2, -3 / 20), (3, 1 / 60))) / h
    scale = np.abs(power).max()
    np.testing.assert_allclose(change, power, rtol=1e-7, atol=1e-7 * scale)


def test_the_random_arms_have_every_drive_and_effect() -> None:
    arms = [random_arm(seed, True) for seed in DRESSED_SEEDS]
    drives = [joint.drive for arm in arms for joint in arm.joints]
    assert {type(drive) for drive in drives} == {NoDrive, DirectDrive, LeveredDrive}
    levers = [drive for drive in drives if isinstance(drive, LeveredDrive)]
    assert {drive.rev for drive in levers} == {1, -1}
    assert any(drive.motor[1] < drive.motor[0] for drive in levers)
    assert any(drive.l1 < drive.l2 for drive in levers)
    uses = {use.name for arm in arms for joint in arm.joints for use in joint.effects}
    assert uses == {
        "viscous_friction",
        "coulomb_friction",
        "drive_inertia",
        "friction_offset",
        "spring",
        "stribeck_friction",
    }
    assert {arm.fluid_density for arm in arms} == {0.0, 1000.0}
    assert any(joint.locked is not None for arm in arms for joint in arm.joints)
