"""Errors on the test record, before and after, with intervals from a block bootstrap.

Blocks keep the colour of the residuals (Kuensch 1989).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from modelgen.dataset import Record
from modelgen.diagnosis.candidates import FittedCandidate, candidate_columns, with_causes
from modelgen.diagnosis.equations import Rows, rows_of
from modelgen.diagnosis.extended.extended_model import Extension, extended, replay, seen_by
from modelgen.diagnosis.extended.findings import Errors, Share
from modelgen.diagnosis.options.thresholds import ExtendedThresholds
from modelgen.evaluation import Evaluator
from modelgen.numeric import Array
from modelgen.regression.weighted import weighted_fit
from modelgen.simulation.windows import Windows

DRAWS = 400  # of the bootstrap: a budget
SEED = 1989


def errors(rows: Rows, before: Array, after: Array, unit: str, limits: ExtendedThresholds) -> Errors:
    """Errors from residuals (M, n) in `unit`; rows that do not move do not count."""
    n = before.shape[1]
    moving = [rows.moving[:, j] for j in range(n)]
    pairs = [(before[m, j], after[m, j]) for j, m in enumerate(moving)]
    found = [compared(old, new, limits) for old, new in pairs]
    return _errors(unit, np.array(found), overall_interval(pairs, limits))


def motion_errors(
    record: Record,
    before: Windows | None,
    after: Windows | None,
    limits: ExtendedThresholds,
) -> Errors:
    """Errors of a free motion's simulated positions [rad, m]; not a number where one cannot be simulated."""
    n = record.n
    found = np.full((n, 5), np.nan)
    interval = np.nan, np.nan
    joints = [] if record.arm is None else [record.arm.joints[i] for i in record.arm.coordinates]
    unit = ", ".join(dict.fromkeys(j.unit for j in joints)) or "rad"
    pair = _deviations(before, after, n)
    if pair is not None:
        old, new = pair
        found = np.array([compared(old[:, j], new[:, j], limits) for j in range(n)])
        interval = overall_interval([(old[:, j], new[:, j]) for j in range(n)], limits)
    return _errors(unit, found, interval)


def motion_shares(
    extension: Extension, test: Rows, on: Sequence[bool], after: Windows | None, limits: ExtendedThresholds
) -> list[Share]:
    """Shares of the causes in what a free motion is simulated better, over the joints where each acts.

    The model is fitted with all causes and with all but this one. on: of each cause, whether it is there,
    `on_test`; one that is not has no share. after: the motion simulated with all. Not a number where either
    cannot be simulated.
    """
    selection, n, found = extension.selection, test.prepared.record.n, []
    for k, (cause, so) in enumerate(zip(selection.causes, on, strict=True)):
        kept = [c for i, c in enumerate(selection.causes) if i != k and on[i]]
        fitted = extended(extension.before, replace(selection, causes=kept), extension.equations)
        pair = _deviations(replay(fitted, test, limits) if so else None, after, n)
        if pair is None:
            found.append(Share())
            continue
        joints = sorted(cause.trial.candidate.joints(n))
        scales = np.maximum(np.sqrt((pair[1] ** 2).mean(axis=0)), 1e-300)
        old, new = (np.concatenate([e[:, j] / scales[j] for j in joints]) for e in pair)
        found.append(Share(*compared(old, new, limits)[2:]))
    return found


def _deviations(before: Windows | None, after: Windows | None, n: int) -> tuple[Array, Array] | None:
    """Simulated minus measured positions (M, n) of both; None where one is missing or of other length."""
    if before is None or after is None or before.simulated.shape != after.simulated.shape:
        return None
    old, new = ((s.simulated - s.measured).reshape(-1, n) for s in (before, after))
    return old, new


def _errors(unit: str, found: Array, interval: tuple[float, float]) -> Errors:
    """From rows of before, after, gain, low and high, one for each joint."""
    before, after, gain, low, high = found.T
    return Errors(unit, before, after, gain, low, high, interval)


def compared(before: Array, after: Array, limits: ExtendedThresholds) -> tuple[float, ...]:
    """RMSE before and after, gain in percent and its interval, from errors (M,) in order of time.

    The interval is not a number where there are fewer rows than blocks, all of them are where there is none.
    """
    count = limits.bootstrap_blocks
    if not len(before):
        return (np.nan,) * 5
    old, new = np.sqrt((before**2).mean()), np.sqrt((after**2).mean())
    found = float(old), float(new), float(100 * (1 - new / old))
    if len(before) < count:
        return *found, np.nan, np.nan
    gains = 100 * (1 - np.sqrt(_ratios(before, after, count)))
    low, high = np.quantile(gains, limits.interval_quantiles)
    return *found, float(low), float(high)


def overall_interval(pairs: Sequence[tuple[Array, Array]], limits: ExtendedThresholds) -> tuple[float, float]:
    """Interval of the gain over all joints, in percent, from each joint's errors before and after.

    The joints' blocks are drawn together: what disturbs one may disturb all.
    """
    count = limits.bootstrap_blocks
    known = [(a, b) for a, b in pairs if len(a) >= count and a.any()]
    if not known:
        return float("nan"), float("nan")
    ratios = np.mean([_ratios(a, b, count) for a, b in known], axis=0)
    low, high = np.quantile(100 * (1 - np.sqrt(ratios)), limits.interval_quantiles)
    return float(low), float(high)


def _ratios(before: Array, after: Array, count: int) -> Array:
    """Mean squares after over before, of as many draws of blocks; the same blocks whatever the errors."""
    random = np.random.default_rng(SEED)
    a, b = before**2, after**2
    parts = np.array_split(np.arange(len(a)), count)
    sums = np.array([[a[p].sum(), b[p].sum()] for p in parts])
    drawn = sums[random.integers(count, size=(DRAWS, count))].sum(axis=1)
    return np.asarray(drawn[:, 1] / drawn[:, 0])


def residuals(test: Rows, extension: Extension, there: Sequence[bool]) -> tuple[Array, Array]:
    """On the test record (M, n), in the unit of its efforts: before and after.

    there: of each cause, whether the record has it, `on_test`.
    """
    selection, before, after = extension.selection, extension.before, extension.after
    old = (test.effort - test.columns @ before.theta) * test.gain
    if not selection.causes:
        return old, old
    if any(c.trial.candidate.coming for c in selection.causes):
        return old, _left(test, extension, there, _alike(extension)[1]) * test.gain
    seen = seen_by(test.prepared, after.arm)
    rows = rows_of(Evaluator(after.arm), after.model, seen, after.theta, after.rows[0].baseline)
    return old, (rows.effort - rows.columns @ after.theta) * test.gain


def on_test(extension: Extension, test: Rows) -> tuple[bool, ...]:
    """Whether each cause is there on the test record. Of what comes and goes between records nobody has said
    it: it is there where it leaves less, in units of the noise.
    """
    trials = [c.trial for c in extension.selection.causes]
    if not any(t.candidate.coming for t in trials):
        return (True,) * len(trials)
    sizes = np.maximum(extension.selection.system.sizes, 1e-300)
    _, theta = _alike(extension)

    def size(there: tuple[bool, ...]) -> float:
        return float((((_left(test, extension, there, theta) / sizes) ** 2)[test.moving]).sum())

    return min(product(*((True, False) if t.candidate.coming else (True,) for t in trials)), key=size)


def _alike(extension: Extension) -> tuple[list[FittedCandidate], Array]:
    """The causes with columns of the training records made at the reported parameters, as those of the test
    record are, and the unknowns with which they leave least there.
    """
    selection = extension.selection
    own = selection.system.equations
    equations, trials = extension.equations.with_rows(own.rows), []
    for trial in (c.trial for c in selection.causes):
        values = {**trial.values, **trial.around}
        made = candidate_columns(trial.candidate, values, equations, extension.base)
        sound = made is not None and all(np.isfinite(table).all() for table in made)
        trials.append(replace(trial, columns=made) if sound and made is not None else trial)
    return trials, weighted_fit(own.rows, with_causes(own, trials))


def _left(test: Rows, extension: Extension, there: Sequence[bool], theta: Array) -> Array:
    """What the causes that are there leave of the test record's efforts (M, n)."""
    selection = extension.selection
    table = [test.columns]
    for cause, so in zip(selection.causes, there, strict=True):
        found = columns_of(cause.trial, test, extension)
        assert found is not None
        table.append(found if so else np.zeros_like(found))
    return np.asarray(test.effort - np.concatenate(table, axis=2) @ theta)


def columns_of(trial: FittedCandidate, test: Rows, extension: Extension) -> Array | None:
    """Columns (M, n, k) of a cause on another record than those it was fitted to, as if it is there.

    None where it cannot stand there.
    """
    equations, values = extension.equations.with_rows([test]), {**trial.values, **trial.around}
    candidate = replace(trial.candidate, absent=frozenset())
    found = candidate_columns(candidate, values, equations, extension.base)
    return None if found is None else found[0]


def shares(extension: Extension, test: Rows, on: Sequence[bool], pair: tuple[Array, Array]) -> list[Share]:
    """Shares of the causes, over the joints where each acts, in units of what all causes leave there.

    The model is fitted to the training records, with all causes as the extended one is, and with all but this
    one; values that were searched for stay. on: of each cause, whether it is there, `on_test`. Where it is
    not, its share is what the arm's parameters are better for. pair: the `residuals` before and after. Not a
    number where one of the causes cannot stand on that record.
    """
    selection, limits = extension.selection, extension.equations.thresholds.extended
    equations, (trials, _) = selection.system.equations, _alike(extension)
    made = [columns_of(trial, test, extension) for trial in trials]
    there = [table for table in made if table is not None and np.isfinite(table).all()]
    if len(there) < len(trials):
        return [Share()] * len(trials)
    there = [table if so else np.zeros_like(table) for table, so in zip(there, on, strict=True)]

    def left(kept: Sequence[int]) -> Array:
        """Residuals (M, n) of the model with some of the causes."""
        theta = weighted_fit(equations.rows, with_causes(equations, [trials[k] for k in kept]))
        table = np.concatenate([test.columns, *(there[k] for k in kept)], axis=2)
        return np.asarray(test.effort - table @ theta)

    bare, with_all = (e / test.gain for e in pair)
    moving = np.where(test.moving, with_all, np.nan)
    sizes = [max(float(np.sqrt(np.nanmean(e**2))), 1e-300) if np.isfinite(e).any() else 1.0 for e in moving.T]
    found = []
    for k in range(len(trials)):
        others = [i for i in range(len(trials)) if i != k]
        without = left(others) if others else bare
        places = trials[k].candidate.joints(len(sizes))
        before, after = (
            np.concatenate([e[test.moving[:, j], j] / sizes[j] for j in places]) for e in (without, with_all)
        )
        found.append(Share(*compared(before, after, limits)[2:]))
    return found
