"""The regressor for adaptive control (Slotine and Li 1987)."""

from collections.abc import Callable

import numpy as np
import pytest
from witness.arms import RANDOM, SHIPPED, Emitted
from witness.bodies import random_bodies
from witness.compare import agree
from witness.mechanism import Mechanism, states

each_arm = pytest.mark.parametrize("make", [*SHIPPED, *RANDOM])


class Case:
    """One arm with random parameters at random states."""

    def __init__(self, make: Callable[[], Emitted]) -> None:
        self.emitted = make()
        mechanism = Mechanism(self.emitted.arm)
        rng = np.random.default_rng(13)
        self.theta = self.emitted.base(mechanism.standard(random_bodies(self.emitted.arm, rng), rng))
        self.q, self.dq, self.ddq = states(self.emitted.arm, 4)
        self.gains = mechanism.gains(self.q)

    def effort(self, dq_r: np.ndarray, ddq_r: np.ndarray) -> np.ndarray:
        """Y(q, dq, dq_r, ddq_r) theta at the joints."""
        columns = self.emitted("slotine_li_regressor", self.q, self.dq, dq_r, ddq_r)
        return columns @ self.theta * self.gains


@each_arm
def test_with_the_motion_itself_as_reference_it_is_the_regressor(make: Callable[[], Emitted]) -> None:
    case = Case(make)
    agree(
        case.emitted("slotine_li_regressor", case.q, case.dq, case.dq, case.ddq),
        case.emitted("regressor", case.q, case.dq, case.ddq),
    )


@each_arm
def test_it_is_affine_in_the_reference_with_the_mass_matrix_before_its_acceleration(
    make: Callable[[], Emitted],
) -> None:
    case = Case(make)
    zero = np.zeros_like(case.q)
    rng = np.random.default_rng(1)
    first, second = rng.uniform(-2, 2, (2, *case.q.shape))
    rest = case.effort(zero, zero)
    both = case.effort(first + 2 * second, zero)
    parts = case.effort(first, zero) + 2 * case.effort(second, zero) - 2 * rest
    agree(both, parts)
    mass = case.emitted("mass_matrix", case.q, case.theta)
    agree(case.effort(zero, case.ddq) - rest, np.einsum("sij,sj->si", mass, case.ddq))


@each_arm
def test_mass_rate_less_twice_coriolis_is_skew_symmetric(make: Callable[[], Emitted]) -> None:
    """Columns of C through unit reference velocities; dM/dt by differences of M along dq."""
    case = Case(make)
    n = case.q.shape[1]
    zero = np.zeros_like(case.q)
    rest = case.effort(zero, zero)
    coriolis = np.stack([case.effort(zero + unit, zero) - rest for unit in np.eye(n)], axis=2)
    h = 1e-3

    def mass(t: float) -> np.ndarray:
        return np.asarray(case.emitted("mass_matrix", case.q + case.dq * t, case.theta))

    rate = sum(c * (mass(k * h) - mass(-k * h)) for k, c in ((1, 3 / 4), (2, -3 / 20), (3, 1 / 60))) / h
    skew = rate - 2 * coriolis
    scale = max(np.abs(rate).max(), 1e-3 * np.abs(mass(0)).max())
    assert np.abs(skew + np.swapaxes(skew, 1, 2)).max() <= 1e-9 * scale
    assert n == 1 or np.abs(coriolis).max() > 1e-6 * scale  # else nothing has been tested


def test_friction_goes_with_the_motion_not_with_its_reference() -> None:
    case = Case(SHIPPED[3].values[0])  # gravity_arm
    assert case.emitted.arm.name == "gravity_arm"
    names = [base.name for base in case.emitted.model.grouping.base]
    columns = case.emitted("slotine_li_regressor", case.q, case.dq, -case.dq, case.ddq)
    for n in (1, 2):
        np.testing.assert_array_equal(columns[:, n - 1, names.index(f"FV{n}")], case.dq[:, n - 1])
        np.testing.assert_array_equal(columns[:, n - 1, names.index(f"FC{n}")], np.sign(case.dq[:, n - 1]))
