"""Noisy positions: least squares is biased, instruments are not, and the test says which is the case."""

from __future__ import annotations

import numpy as np
import pytest
from identification_support import RATE, bare, tapering
from witness.bodies import Body
from witness.rigid_bodies import RigidBodies

from modelgen.dataset import Record, Settings, prepare
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.functions import build_model
from modelgen.functions.nominal import base_matrix
from modelgen.identification import Instruments, identify, verdict
from modelgen.identification.instrumental import Instrument, compared
from modelgen.identification.simulated_instruments import Tracking
from modelgen.regression.least_squares import Regression
from modelgen.simulation import Reference

PERIOD = 2.0  # s, short and fast: accelerations count, and their errors with them


def record(arm: Arm, bodies: list[Body], positions: float, seed: int, periods: int = 8) -> Record:
    """Identical periods, efforts of Pinocchio's links with little noise, positions with noise of a size."""
    rng = np.random.default_rng(seed)
    t = np.arange(round(periods * PERIOD * RATE)) / RATE
    n = len(arm.coordinates)
    q, dq, ddq = np.zeros((len(t), n)), np.zeros((len(t), n)), np.zeros((len(t), n))
    shape = np.random.default_rng(77)
    for k in range(1, 4):
        a, b = shape.uniform(-0.25, 0.25, (2, n))
        w = 2 * np.pi * k / PERIOD
        s, c = np.sin(w * t)[:, None], np.cos(w * t)[:, None]
        q, dq, ddq = q + a * s + b * c, dq + w * (a * c - b * s), ddq - w * w * (a * s + b * c)
    links = RigidBodies(arm, bodies)
    effort = np.array([links.effort(*x) for x in zip(q, dq, ddq, strict=True)])
    effort += 0.02 * np.sqrt(np.mean(effort**2, axis=0)) * rng.normal(size=effort.shape)
    noisy = q + positions * rng.normal(size=q.shape)
    ones = np.ones_like(effort)
    return Record("simulated", t, noisy, noisy, input=effort, gain=ones, effort_unit=("N m",) * n, arm=arm)


SETTINGS = Settings(cutoff=20.0, position_cutoff=40.0)


def test_instruments_take_the_bias_away() -> None:
    bodies = tapering(3)
    arm = bare("rx90", bodies)
    prepared = [prepare(record(arm, bodies, 1e-3, 1), SETTINGS)]
    least, iv = (identify(prepared, arm, method=m) for m in ("wls", "iv"))
    truth = base_matrix(least.model) @ np.concatenate([b.ten for b in bodies])
    errors = []
    for found in (least, iv):
        value = np.array([e.value for e in found.estimates])
        std = np.array([e.std for e in found.estimates], dtype=float)
        errors.append((value - truth) / std)
    assert np.sqrt(np.mean(errors[0] ** 2)) > 4  # far outside of what least squares claims
    assert np.sqrt(np.mean(errors[1] ** 2)) < 2
    assert least.comparison is not None
    assert least.comparison.biased
    assert "bias least squares" in verdict(least)


@pytest.mark.parametrize("seed", range(1, 6))
def test_exact_positions_raise_no_alarm(seed: int) -> None:
    bodies = tapering(3)
    arm = bare("rx90", bodies)
    found = identify([prepare(record(arm, bodies, 1e-7, seed), SETTINGS)], arm)
    assert found.comparison is not None
    assert not found.comparison.biased
    assert "bias" not in verdict(found)


def test_the_model_under_control_is_an_instrument_where_nothing_repeats() -> None:
    bodies = tapering(3)
    arm = bare("rx90", bodies)
    rng, n = np.random.default_rng(1), 6
    t = np.arange(round(12 * RATE)) / RATE
    q, dq, ddq = np.zeros((len(t), n)), np.zeros((len(t), n)), np.zeros((len(t), n))
    shape = np.random.default_rng(77)
    for w in 2 * np.pi * np.array([0.47, 0.93, 1.51]):
        a, b = shape.uniform(-0.25, 0.25, (2, n))
        s, c = np.sin(w * t)[:, None], np.cos(w * t)[:, None]
        q, dq, ddq = q + a * s + b * c, dq + w * (a * c - b * s), ddq - w * w * (a * s + b * c)
    links = RigidBodies(arm, bodies)
    effort = np.array([links.effort(*x) for x in zip(q, dq, ddq, strict=True)])
    effort += 0.02 * np.sqrt(np.mean(effort**2, axis=0)) * rng.normal(size=effort.shape)
    noisy, ones = q + 1e-3 * rng.normal(size=q.shape), np.ones_like(effort)
    made = Record("simulated", t, noisy, noisy, input=effort, gain=ones, effort_unit=("N m",) * n, arm=arm)
    prepared = [prepare(made, SETTINGS)]
    least = identify(prepared, arm)
    assert least.comparison is None
    # The controller is not known: PI loops wide enough for the motion, after the measured positions.
    iv = identify(prepared, arm, method="iv", instruments=Instruments("auto", Tracking(arm)))
    truth = base_matrix(least.model) @ np.concatenate([b.ten for b in bodies])
    errors = []
    for found in (least, iv):
        value = np.array([e.value for e in found.estimates])
        std = np.array([e.std for e in found.estimates], dtype=float)
        errors.append((value - truth) / std)
    assert np.sqrt(np.mean(errors[0] ** 2)) > 4
    assert np.sqrt(np.mean(errors[1] ** 2)) < 2
    assert iv.comparison is not None
    assert iv.comparison.simulated
    assert iv.comparison.biased


def test_a_reference_of_another_time_is_refused() -> None:
    bodies = tapering(3)
    arm = bare("rx90", bodies)
    prepared = [prepare(record(arm, bodies, 1e-4, 1, periods=2), SETTINGS)]
    late = Reference(np.linspace(100.0, 101.0, 9), np.zeros((9, 6)))
    with pytest.raises(InputError, match="expected it to cover simulated, 0 to"):
        identify(
            prepared, arm, method="iv", instruments=Instruments("simulated", Tracking(arm, reference=late))
        )
    with pytest.raises(InputError, match="expected auto, period, simulated"):
        identify(prepared, arm, instruments=Instruments("simulation"))


def test_parameters_that_cannot_be_simulated_are_refused() -> None:
    bodies = tapering(3)
    arm = bare("rx90", bodies)
    prepared = prepare(record(arm, bodies, 1e-4, 1, periods=2), SETTINGS)
    names = [b.name for b in build_model(arm).grouping.base]
    with pytest.raises(InputError, match=r"does not get through simulated: .*; expected records"):
        Tracking(arm)(prepared, dict.fromkeys(names, 0.0))


def test_without_periods_there_are_no_instruments() -> None:
    bodies = tapering(3)
    arm = bare("rx90", bodies)
    prepared = [prepare(record(arm, bodies, 1e-4, 1, periods=1), SETTINGS)]
    assert identify(prepared, arm).comparison is None
    with pytest.raises(InputError, match="no motion that repeats"):
        identify(prepared, arm, method="iv")


@pytest.mark.parametrize("unit", [1.0, 1e-9, 1e9])
def test_the_unit_of_a_parameter_is_no_part_of_its_value(unit: float) -> None:
    """One by counts of a motor has columns ten powers of ten longer than an inertia: both are found."""
    rng = np.random.default_rng(3)
    motion = rng.normal(size=(4000, 1, 2)) * np.array([1.0, unit])
    truth = np.array([2.0, 0.5 / unit])
    effort = motion @ truth + 0.01 * rng.normal(size=(4000, 1))
    seen = motion + 0.3 * rng.normal(size=motion.shape) * np.array([1.0, unit])
    other = motion + 0.3 * rng.normal(size=motion.shape) * np.array([1.0, unit])
    regression = Regression([effort], [seen], [np.ones((4000, 1), dtype=bool)])
    least = regression.solve("ols")
    found = compared(regression, least, [Instrument(other, np.ones((4000, 1), dtype=bool))])
    assert found is not None
    np.testing.assert_allclose(found.solution.theta / truth, 1.0, atol=0.05)
    assert (np.abs(least.theta / truth - 1.0) > 0.05).all()  # errors of the columns bias least squares
