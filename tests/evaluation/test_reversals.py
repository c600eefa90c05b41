"""What jumps where a joint turns back: its mean over the sample where efforts are means, else not asked."""

from __future__ import annotations

import numpy as np
import pytest
from arms_support import base_vector, standard_vector

from modelgen.dataset import Record, prepare
from modelgen.dataset.processing.rest import directed
from modelgen.description import Arm, DirectDrive, EffectUse, Joint
from modelgen.evaluation import Evaluator, Motion
from modelgen.evaluation.reversals import pieces_of
from modelgen.functions import build_model
from modelgen.identification.rows import Rows as Sampled

RUBBING = tuple(EffectUse(n) for n in ("viscous_friction", "coulomb_friction"))
ARM = Arm(
    "two",
    (
        Joint("j1", "revolute", drive=DirectDrive(80.0, 0.05), effects=RUBBING),
        Joint("j2", "revolute", d=0.4, antecedent=0, drive=DirectDrive(50.0, 0.05), effects=RUBBING),
    ),
    (None, None),
    (0.0, -9.81, 0.0),
)
STEP, FINE = 0.01, 400
W = 2 * np.pi * np.array([[0.31, 0.57], [0.93, 1.21]])  # [rad/s] of two sines by joint
SIZE, PHASE = np.array([[0.5, 0.3], [0.2, 0.25]]), np.array([[0.3, 1.1], [2.0, 0.4]])


def moved(t: np.ndarray, order: int) -> np.ndarray:
    """Positions (N, 2) or their derivatives."""
    return np.asarray(
        (SIZE * W**order * np.sin(W * t[:, None, None] + PHASE + order * np.pi / 2)).sum(axis=1)
    )


def motion(t: np.ndarray, *, held: bool) -> Motion:
    return Motion(t, moved(t, 0), moved(t, 1), moved(t, 2), held=held)


def test_a_regressor_has_the_mean_over_the_sample_where_a_joint_turns_back() -> None:
    """Against the mean of instants four hundred times as close."""
    model, evaluator = build_model(ARM), Evaluator(ARM)
    t = np.arange(0.0, 8.0, STEP)
    base = base_vector(model, standard_vector(model, np.random.default_rng(1)))
    found = evaluator.regressor(model, motion(t, held=True), base)
    instants = evaluator.regressor(model, motion(t, held=False), base)
    around = (t[:, None] + STEP * ((np.arange(FINE) + 0.5) / FINE - 0.5)).ravel()
    wanted = evaluator.regressor(model, motion(around, held=False), base)
    wanted = wanted.reshape(len(t), FINE, *wanted.shape[1:]).mean(axis=1)
    names = [b.name for b in model.grouping.base]
    dry = [names.index("FC1"), names.index("FC2")]
    left, before = (np.sqrt(((x - wanted)[1:-1][:, :, dry] ** 2).sum(axis=(0, 2))) for x in (found, instants))
    assert (left < 0.1 * before).all()  # what a speed that is no straight line leaves
    turning = np.abs(moved(t, 1)) < np.abs(np.gradient(moved(t, 1), axis=0)) / 2
    assert turning.any(axis=0).all()
    still = ~turning.any(axis=1)
    assert np.array_equal(found[still], instants[still])


def test_several_joints_may_turn_back_in_one_sample() -> None:
    dq = np.column_stack([np.linspace(-2.3, 1.7, 5), np.linspace(1.6, -2.4, 5)])
    pieces = pieces_of(dq)
    assert pieces is not None
    ((sample,), signs) = pieces.means(np.sign(pieces.speeds(dq)))
    # the first joint turns 0.3 of a sample after the stamp, the second 0.4 before it
    assert sample == 2
    assert signs[0] == pytest.approx([-0.6, -0.8])
    assert pieces.share.sum() == pytest.approx(1.0)


@pytest.mark.parametrize("within", [0.15, 1.0])
def test_the_direction_is_not_known_within_the_time_that_an_instant_is(within: float) -> None:
    t = np.arange(0.0, 6.0, STEP)
    dq = moved(t, 1)
    known = directed(dq, (0.0, 0.0), within)
    early, late = (np.sign(moved(t + side * 0.98 * within * STEP, 1)) for side in (-1, 1))
    assert not known[early != late].any()
    early, late = (np.sign(moved(t + side * 1.05 * within * STEP, 1)) for side in (-1, 1))
    assert known[early == late][1:-1].all()


@pytest.mark.parametrize("step", [3e-4, 1.5e-3, 6e-3])
def test_directions_that_rounded_positions_feign_do_not_count(step: float) -> None:
    """Where counts say the wrong way, or all but, against the motion itself; and little else is left out."""
    t = np.arange(0.0, 60.0, STEP / 4)
    q = moved(t, 0)
    read = step * np.rint(q / step)
    prepared = prepare(Record("a", t, read, read, input=np.zeros(q.shape), effort_unit=("N m",) * 2))
    true = np.sign(moved(t, 1))
    wrong = np.sign(prepared.dq) != true
    known = directed(prepared.dq, prepared.settings.noise, 0.0)
    inner = slice(100, -100)  # derivatives of the ends are one-sided
    assert wrong[inner].sum() > 5
    assert (wrong & known)[inner].sum() <= 0.1 * wrong[inner].sum()
    slow = np.abs(moved(t, 1)) < 2.5 * np.array(prepared.settings.noise)
    assert not (~known & ~slow)[inner].any()
    assert (~known)[inner].mean() < 0.05


def test_compiled_columns_have_the_same_means() -> None:
    """Of a record, through the filter, by the compiled regressor and by NumPy."""
    t = np.arange(0.0, 20.0, STEP)
    q = moved(t, 0)
    record = Record("held", t, q, q, q, held=True, hold=STEP / 2)
    prepared = prepare(record)
    model = build_model(ARM)
    rows = Sampled(model, Evaluator(ARM))
    theta = np.zeros(len(model.grouping.base))
    effort, compiled = rows.of(prepared, theta)
    rows._compiled = {}
    again, plain = rows.of(prepared, theta)
    np.testing.assert_allclose(compiled, plain, atol=1e-12 * np.abs(plain).max())
    np.testing.assert_array_equal(effort, again)
