"""Smooth functions that stand for no law, on equations of which all is known: no arm, no filter."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from diagnosis_support import PERIOD, PERIODS, cubic, made, offset, system_of
from numpy.random import default_rng
from scipy.signal import lfilter
from scipy.stats import multivariate_normal

from modelgen.diagnosis.adequacy.free_form import ahead
from modelgen.diagnosis.adequacy.smooth_functions import (
    Likeness,
    SmoothFunction,
    functions,
    likeness,
    log_evidence,
)
from modelgen.diagnosis.candidates.candidate import Candidate
from modelgen.diagnosis.candidates.fitted import FittedCandidate
from modelgen.diagnosis.evidence.noise import Whitener
from modelgen.diagnosis.options.thresholds import EvidenceThresholds, SelectionThresholds
from modelgen.diagnosis.selection.rivals import left_to
from modelgen.numeric import Array

WHITENING_ORDER = EvidenceThresholds().whitening_order


def spot(x: Array) -> Array:
    """A force in one place."""
    return 5.0 * np.exp(-0.5 * (x / 0.15) ** 2)


def step(x: Array) -> Array:
    """Another force below a place than above it."""
    return np.asarray(0.6 * np.tanh((x - 0.3) / 0.2))


BY_PLACE = "by place"


def judged(force: Any, seed: int, *laws: Any) -> tuple[float, Likeness | None]:
    """How far a function of the place is ahead of laws, and what is left beside them is most like."""
    rows, q, periods = made(force, seed)
    bare = system_of(rows, [r.columns for r in rows], periods)
    every = [np.stack([law(x[:, 0]) for law in laws], axis=1)[:, None] for x in q]
    tables = [np.concatenate([r.columns, c], axis=2) for r, c in zip(rows, every, strict=True)]
    system = system_of(rows, tables, periods)
    without = system_of(rows, [r.columns for r in rows], periods, noise=system)
    trials = []
    for k in range(len(laws)):
        columns = [c[:, :, [k]] for c in every]
        gain = bare.gain(columns)
        assert gain is not None
        trials.append(FittedCandidate(Candidate("friction_offset", 1), {}, columns, gain))
    shape = SmoothFunction(BY_PLACE, {0: functions(q, 0.2)})
    return ahead([shape], trials, without)[0], likeness([shape], system)


def test_a_law_that_is_there_is_ahead_of_a_function() -> None:
    for seed in range(10):
        more, like = judged(offset, seed, offset)
        assert more < -5.0
        assert like is None


def test_a_function_of_the_place_is_ahead_of_a_law_in_its_stead() -> None:
    """And what is left is like a function of the place."""
    for seed in range(10):
        more, like = judged(spot, seed, offset)
        assert more > 0.0
        assert like is not None
        assert like.shape.text == BY_PLACE


def test_a_function_is_ahead_of_laws_that_make_up_one_together() -> None:
    """Of a step, an offset and a cubic law."""
    more = [judged(step, seed, offset, cubic)[0] for seed in range(30)]
    assert sum(x > 0.0 for x in more) >= 24


def test_two_laws_that_are_there_are_ahead_together() -> None:
    for size in (0.5, 1.0):
        for seed in range(10):
            both = judged(lambda x, size=size: size * (offset(x) + 0.2 * cubic(x)), seed, offset, cubic)
            assert both[0] < 0.0


def test_a_rival_loses_its_evidence_beside_the_cause_and_another_cause_keeps_it() -> None:
    def kept(force: Any, law: Any) -> float:
        """Evidence of a law beside an offset, over that without one."""
        rows, q, periods = made(force)
        tables = [r.columns for r in rows]
        columns = [law(x[:, 0])[:, None, None] for x in q]
        alone = system_of(rows, tables, periods).gain(columns)
        assert alone is not None
        assert alone.delta_bic > 15.0
        beside = [
            np.concatenate([t, offset(x)[:, None, None]], axis=2) for t, x in zip(tables, q, strict=True)
        ]
        trial = FittedCandidate(Candidate("friction_offset", 1), {}, columns, alone)
        return left_to(trial, system_of(rows, beside, periods)) / alone.delta_bic

    assert (
        kept(offset, lambda x: 1.0 + 0.1 * np.sin(x))
        < SelectionThresholds().max_rival_share
        < kept(lambda x: offset(x) + 0.2 * cubic(x), cubic)
    )


def test_beside_a_law_that_is_there_the_rest_is_still_called_what_it_is() -> None:
    """Ten times the spot's share of the power is the law's."""
    _, like = judged(lambda x: 6.0 * offset(x) + spot(x), 0, offset)
    assert like is not None


def known_noise(*sizes: float) -> Any:
    """As of a system whose joints have white noise of these sizes."""
    taps = np.eye(1, WHITENING_ORDER + 1)[0]
    return SimpleNamespace(whiteners=[Whitener(taps, size) for size in sizes])


def test_evidence_is_that_of_a_gaussian_process() -> None:
    """Its density with the kernel written out, noise and baseline integrated out, over that without it."""
    rows, q, periods = made(spot, 3)
    system = system_of(rows, [r.columns for r in rows], periods, known_noise(1.0))
    found = log_evidence(SmoothFunction("", {0: functions(q, 0.5)}), system)

    used = slice(WHITENING_ORDER, None)  # rows with as many before them
    x = np.concatenate([p[used] for p in q]) / (0.5 * np.ptp(np.concatenate(q)))
    y = np.concatenate([r.effort[used] for r in rows])
    baseline = np.concatenate([r.columns[used, 0] for r in rows])
    left = np.linalg.qr(baseline, mode="complete")[0][:, baseline.shape[1] :]
    kernel = left.T @ np.exp(-0.5 * (x - x.T) ** 2) @ left
    right = (left.T @ y)[:, 0]

    def twice_log(size: float) -> float:
        """With the noise at its best."""
        shape = size * kernel + np.eye(len(right))
        power = float(right @ np.linalg.solve(shape, right)) / len(right)
        return 2.0 * float(multivariate_normal.logpdf(right, cov=power * shape))

    best = max(twice_log(size) for size in np.logspace(-2, 2, 13)) - twice_log(0.0)
    assert found.evidence == pytest.approx(best - np.log(len(x)), abs=1.0)


def test_a_function_at_one_joint_that_sets_a_parameter_free_is_worth_what_the_other_joint_gains() -> None:
    """Joint 1 would have another parameter than joint 2, which knows it ten times better; a function in its
    place at joint 2 leaves it to joint 1. Of its own, joint 2 has nothing to explain.
    """
    rows, q, periods = made(lambda x: 0.0 * x, 4)
    both = []
    for k, (r, x) in enumerate(zip(rows, q, strict=True)):
        columns = np.stack([np.cos(3.0 * x), x], axis=1)
        noise = default_rng([3, k]).normal(size=(len(x), 2)) * (1.0, 0.1)
        effort = columns[:, :, 0] * (3.0, 1.0) + noise
        both.append(replace(r, effort=effort, columns=columns, moving=np.ones(effort.shape, dtype=bool)))
    system = system_of(both, [r.columns for r in both], periods, known_noise(1.0, 0.1))
    found = log_evidence(SmoothFunction("", {1: functions(q, 0.3)}), system)
    most = float(system.white.counts @ np.log(system.white.rss / system.white.counts))
    assert 0.8 * most < found.evidence < most


def test_slow_noise_is_no_function_of_the_place() -> None:
    fair = []
    for seed in range(40):
        random = default_rng([7, seed])
        noise = lfilter([0.25], [1.0, -0.97], random.normal(size=(2, PERIOD * PERIODS + 500)))[:, 500:]
        rows, q, periods = made(lambda x: 0.0 * x, seed)
        red = [replace(r, effort=r.effort + e[:, None]) for r, e in zip(rows, noise, strict=True)]
        found = log_evidence(
            SmoothFunction("", {0: functions(q, 0.2)}), system_of(red, [r.columns for r in red], periods)
        )
        fair.append(found.evidence)
    assert max(fair) < 3.0


def test_the_whitened_equations_leave_white_noise_where_errors_repeat_whose_size_is_known() -> None:
    def left(*, known: bool) -> tuple[float, float]:
        """Spread, and correlation from row to row."""
        rows, _, periods = made(lambda x: 0.0 * x)
        random = default_rng(8)
        for k, r in enumerate(rows):
            errors = [np.tile(np.diff(random.normal(size=PERIOD + 1)), PERIODS)[:, None] for _ in range(2)]
            rows[k] = replace(
                r, effort=r.effort + 2.0 * errors[0], repeated=2.0 * errors[1] if known else None
            )
        white = system_of(rows, [r.columns for r in rows], periods).white.left
        return float(white.std()), float(np.corrcoef(white[1:], white[:-1])[0, 1])

    spread, correlation = left(known=True)
    assert spread == pytest.approx(1.0, abs=0.1)
    assert correlation == pytest.approx(0.0, abs=0.1)
    spread, correlation = left(known=False)
    assert spread > 2.0
    assert correlation < -0.3


def test_functions_have_the_kernel_of_the_process() -> None:
    x = np.linspace(-1.0, 2.0, 400)[:, None]
    (table,) = functions([x], 0.2)
    assert np.abs(table @ table.T - np.exp(-0.5 * ((x - x.T) / 0.6) ** 2)).max() < 1e-6
