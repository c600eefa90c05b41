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

from modelgen.diagnosis.adequacy.smooth_functions import SmoothFunction, functions, log_evidence
from modelgen.diagnosis.adequacy.stand_ins import without_stand_ins
from modelgen.diagnosis.candidates.candidate import Candidate
from modelgen.diagnosis.candidates.fitted import FittedCandidate
from modelgen.diagnosis.equations.rows import Rows
from modelgen.diagnosis.evidence.noise import Whitener
from modelgen.diagnosis.options.thresholds import EvidenceThresholds, SelectionThresholds
from modelgen.diagnosis.selection.cause import Cause, Selection
from modelgen.diagnosis.selection.rivals import left_to
from modelgen.numeric import Array

WHITENING_ORDER = EvidenceThresholds().whitening_order


def spot(x: Array) -> Array:
    """A force in one place."""
    return 5.0 * np.exp(-0.5 * (x / 0.15) ** 2)


def step(x: Array) -> Array:
    """Another force below a place than above it."""
    return np.asarray(0.6 * np.tanh((x - 0.3) / 0.2))


def judged(rows: list[Rows], q: list[Array], periods: list[int | None], *laws: Any) -> tuple[Any, ...]:
    """`outdone`, of causes with these columns that were taken one after the other."""
    causes: list[Cause] = []
    system = system_of(rows, [r.columns for r in rows], periods)
    tables = [r.columns for r in rows]
    for name, law in zip(("friction_offset", "asymmetric_viscous_friction"), laws, strict=False):
        columns = [law(x[:, 0])[:, None, None] for x in q]
        gain = system.gain(columns)
        assert gain is not None
        trial = FittedCandidate(Candidate(name, 1), {}, columns, gain)
        causes.append(Cause(trial, gain.delta_bic, 5.0, 5.0))
        tables = [np.concatenate([t, c], axis=2) for t, c in zip(tables, columns, strict=True)]
        system = system_of(rows, tables, periods)
    return without_stand_ins(
        Selection(causes, system, []), system.equations, [SmoothFunction("by place", {0: functions(q, 0.2)})]
    )


def test_a_law_that_is_there_stays() -> None:
    for seed in range(10):
        rows, q, periods = made(offset, seed)
        selection, dropped, likeness = judged(rows, q, periods, offset)
        assert len(selection.causes) == 1
        assert not dropped
        assert likeness is None


def test_a_law_that_stands_for_a_place_goes() -> None:
    """And what is left is like a function of the place."""
    for seed in range(10):
        rows, q, periods = made(spot, seed)
        selection, dropped, likeness = judged(rows, q, periods, offset)
        assert not selection.causes
        assert len(dropped) == 1
        assert likeness is not None
        assert likeness.shape.text == "by place"


def test_laws_that_stand_for_a_place_together_go() -> None:
    """Of a step, an offset and a cubic law leave too little to be seen beside them in 6 of 30."""
    left = []
    for seed in range(30):
        rows, q, periods = made(step, seed)
        left.append(len(judged(rows, q, periods, offset, cubic)[0].causes))
    assert left.count(2) <= 1  # 2 if the second law had no price


def test_a_law_alone_goes_where_a_function_has_clearly_more_and_something_beside() -> None:
    """By what it leaves beside it alone, a cubic law in the place of a step would stay in 16 of 30."""
    left = []
    for seed in range(30):
        rows, q, periods = made(step, seed)
        left.append(len(judged(rows, q, periods, cubic)[0].causes))
    assert left.count(1) <= 14


def test_two_laws_that_are_there_stay() -> None:
    for size in (0.5, 1.0):
        for seed in range(10):
            rows, q, periods = made(lambda x, size=size: size * (offset(x) + 0.2 * cubic(x)), seed)
            selection, dropped, _ = judged(rows, q, periods, offset, cubic)
            assert len(selection.causes) == 2
            assert not dropped


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
    rows, q, periods = made(lambda x: 6.0 * offset(x) + spot(x))
    selection, dropped, likeness = judged(rows, q, periods, offset)
    assert len(selection.causes) == 1
    assert not dropped
    assert likeness is not None


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
    """By the plain equations it would be in 3 of 40."""
    slow, fair = [], []
    for seed in range(40):
        random = default_rng([7, seed])
        noise = lfilter([0.25], [1.0, -0.97], random.normal(size=(2, PERIOD * PERIODS + 500)))[:, 500:]
        rows, q, periods = made(lambda x: 0.0 * x, seed)
        red = [replace(r, effort=r.effort + e[:, None]) for r, e in zip(rows, noise, strict=True)]
        found = log_evidence(
            SmoothFunction("", {0: functions(q, 0.2)}), system_of(red, [r.columns for r in red], periods)
        )
        slow.append(found.slow)
        fair.append(found.evidence)
    assert max(fair) < 3.0
    assert sum(x > 10.0 for x in slow) >= 3


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
