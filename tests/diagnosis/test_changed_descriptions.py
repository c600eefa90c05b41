"""Columns of effects in which nothing is linear, against the laws that they stand for, written out."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from arms_support import base_vector, standard_vector

from modelgen.dataset import Record
from modelgen.description import Arm, DirectDrive, EffectUse, Joint
from modelgen.diagnosis.candidates.candidate import Candidate
from modelgen.diagnosis.candidates.columns import slopes
from modelgen.diagnosis.pipeline import diagnose
from modelgen.diagnosis.selection.refit import TURNS, _towards
from modelgen.effects import CATALOGUE
from modelgen.evaluation import Evaluator, Motion
from modelgen.functions import build_model
from modelgen.numeric import Array

RATIO, CONSTANT, GRAVITY = 80.0, 0.05, 9.81
EFFECTS = tuple(EffectUse(n) for n in ("viscous_friction", "coulomb_friction", "drive_inertia"))
JOINT = Joint("j1", "revolute", drive=DirectDrive(RATIO, CONSTANT), effects=EFFECTS)
ONE = Arm("one", (JOINT,), (None,), (0.0, -GRAVITY, 0.0))
TIMES = np.arange(0.0, 30.0, 0.004)


def swing(times: Array, seed: int) -> tuple[Array, Array, Array]:
    """A joint's path (N, 1), nine times over in 30 s."""
    a, b = np.random.default_rng(seed).uniform(-0.5, 0.5, (2, 1, 5)) / (1 + np.arange(5))
    w = 2 * np.pi * 0.3 * (1 + np.arange(5))
    c, s = np.cos(np.multiply.outer(times, w)), np.sin(np.multiply.outer(times, w))
    return c @ a.T + s @ b.T, (c * w) @ b.T - (s * w) @ a.T, -(c * w**2) @ a.T - (s * w**2) @ b.T


def evaluator() -> tuple[Evaluator, Array]:
    model = build_model(ONE)
    return Evaluator(ONE), base_vector(model, standard_vector(model, np.random.default_rng(5)))


@pytest.mark.parametrize("error", [0.3, -0.2])
def test_a_torque_constant_asks_for_current_in_proportion(error: float) -> None:
    """A larger one asks for less: the column is the current itself, whatever the error it is made at."""
    own, base = evaluator()
    motion = Motion(TIMES, *swing(TIMES, 1))
    current = own.inputs(motion, base)
    cause = Candidate("drive_gain_error", 1)
    for made_at in ({}, {"error": error}):
        column = slopes(cause, made_at, motion, own, base)[:, :, 0]
        np.testing.assert_allclose(column, current, atol=1e-9 * np.abs(current).max())
    surplus = 1 / (1 + error) - 1
    assert cause.definition.physical({"surplus": surplus})["error"] == pytest.approx(error)


@pytest.mark.parametrize("offset", [0.5, -0.4])
def test_a_secant_is_the_whole_change(offset: float) -> None:
    """Of the currents where the joint really is; a slope is off by much of that."""
    own, base = evaluator()
    motion = Motion(TIMES, *swing(TIMES, 1))
    moved = replace(motion, q=motion.q + offset)
    change = own.inputs(moved, base) - own.inputs(motion, base)
    cause = Candidate("encoder_offset", 1)
    column = slopes(cause, {"offset": offset}, motion, own, base)[:, :, 0]
    np.testing.assert_allclose(offset * column, change, atol=1e-9 * np.abs(change).max())
    slope = slopes(cause, {}, motion, own, base)[:, :, 0]
    assert np.abs(offset * slope - change).max() > 0.1 * np.abs(change).max()


def test_a_payload_where_it_was_found_has_its_inertia() -> None:
    """m ((x^2 + y^2) ddq + g (x cos q - y sin q)), over the drive's gain."""
    own, base = evaluator()
    q, dq, ddq = swing(TIMES, 2)
    mass, x, y = 3.0, 0.4, -0.2
    torque = mass * ((x**2 + y**2) * ddq + GRAVITY * (x * np.cos(q) - y * np.sin(q)))
    place = {"mass": mass, "x": x, "y": y, "z": 0.1}
    columns = slopes(Candidate("payload_change", 1), place, Motion(TIMES, q, dq, ddq), own, base)
    found = columns @ np.array([mass, mass * x, mass * y, mass * 0.1])
    np.testing.assert_allclose(found, torque / (RATIO * CONSTANT), atol=1e-8 * np.abs(found).max())


def records(law: Callable[[Array], Array], late: float = 0.0) -> list[Record]:
    """Three of one joint: what it needs `late` seconds ahead, by the law that the drive gives it."""
    own, base = evaluator()
    found = []
    for k in range(3):
        needed = law(own.inputs(Motion(TIMES, *swing(TIMES + late, k)), base))
        noise = 0.03 * np.sqrt((needed**2).mean()) * np.random.default_rng([k, 3]).normal(size=needed.shape)
        q = swing(TIMES, k)[0]
        places, ones = RATIO * q, np.ones_like(q)
        found.append(
            Record(f"r{k}", TIMES, q, places, needed + noise, ones, ("A",), motor_side=(True,), arm=ONE)
        )
    return found


@pytest.mark.parametrize("late", [0.008, 0.016])
def test_a_delay_is_found_as_it_was(late: float) -> None:
    found = diagnose(ONE, records(lambda current: current, late), experiment=False)
    assert [c.effect for c in found.causes] == ["time_delay"]
    assert found.causes[0].parameters["delay"].value == pytest.approx(late, rel=0.03)


def test_a_torque_constant_that_grows_is_no_saturation() -> None:
    """The effect's coefficient would be negative: nothing of the kind is named, and nothing is raised."""
    found = diagnose(ONE, records(lambda current: current - 0.05 * current**3 / (current**2).max()))
    for cause in found.causes:
        bounds = {p.name: p.bounds for p in CATALOGUE[cause.effect].accepted()}
        for name, estimate in cause.parameters.items():
            assert bounds[name][0] <= estimate.value <= bounds[name][1]
    assert "torque_constant_saturation" not in [c.effect for c in found.causes]


@pytest.mark.parametrize("bend", [0.9, 1.5])
def test_secants_that_swing_come_to_rest(bend: float) -> None:
    """What is estimated at x is -bend (1 + x), as of a reciprocal: by itself it swings on and on."""
    true = -bend / (1.0 + bend)
    at, way, plain = np.zeros(0), np.zeros(0), 0.0
    for _ in range(TURNS):
        found = -bend * (1.0 + (at if len(at) else np.zeros(1)))
        at, way = _towards(found, at, way)
        plain = -bend * (1.0 + plain)
    assert abs(at[0] - true) < 0.01 * abs(true)
    assert abs(plain - true) > 0.3 * abs(true)
