"""How far the noise of the positions can feign a cause.

Regressors are made of measured positions; where a coarse encoder blurs them, least squares correlates
columns with their own errors (Fuller 1987, "Measurement Error Models", 1.1). What the error of the
regressor leaves in the residuals is measured by blurring the positions once more in the same way and
looking at what that changes (Cook and Stefanski 1994). No column can gain more by following that error
than the error's whole share of the residuals: a gain up to that share is no evidence.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset import Record, drives_of, prepare
from modelgen.diagnosis.equations.rows import Rows, rows_of
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.numeric import Array
from modelgen.regression.weighted import moving_rows

STEPPED = 0.05  # of a count: how far differences may lie from whole counts
SEED = 19940801
ROUNDED = 1.5  # times what rounding leaves in third differences: no other error is there
THIRD = 20.0 / 12.0  # mean square of the third differences of rounding errors, counts squared
ALIKE = 0.5  # counts between readings of two periods


def counts(record: Record) -> Array:
    """Resolution of the logged positions by coordinate, (n,), in the unit that was logged; 0: not stepped."""
    return np.array([_count(_logged(record, j)) for j in range(record.n)])


def _logged(record: Record, j: int) -> Array:
    motor = bool(record.motor_side) and record.motor_side[j]
    return (record.motor if motor else record.q)[:, j]


def _count(values: Array) -> float:
    """The smallest step of which all others are multiples."""
    steps = np.abs(np.diff(values))
    steps = steps[steps > 1e-12 * max(float(np.ptp(values)), 1e-300)]
    if len(steps) < 20:
        return 0.0
    smallest = float(steps.min())
    near = steps[steps < 1.5 * smallest]
    count = float(near.mean())
    off = np.abs(steps / count - np.round(steps / count))[steps < 10 * count]
    return count if float(np.quantile(off, 0.95)) < STEPPED else 0.0


def rounded(record: Record) -> bool:
    """Whether rounding to counts is all the error that the logged positions have.

    By their third differences, in which a motion that is sampled well all but vanishes.
    """
    return all(
        count > 0 and float(np.mean(np.diff(_logged(record, j), 3) ** 2)) <= ROUNDED**2 * THIRD * count**2
        for j, count in enumerate(counts(record))
    )


def blurred(record: Record, which: NDArray[np.bool_] | None = None) -> Record:
    """The record with one more error of a uniform distribution over a count on every position.

    which: of these coordinates (n,) alone.
    """
    random = np.random.default_rng(SEED)
    q, motor = record.q.copy(), record.motor.copy()
    drives = drives_of(record.arm) if record.arm is not None else ()
    for j, count in enumerate(counts(record)):
        if not count or (which is not None and not which[j]):
            continue
        error = random.uniform(-0.5, 0.5, len(q)) * count
        if record.motor_side and record.motor_side[j]:
            motor[:, j] += error
        else:
            q[:, j] += error
            if drives:
                motor[:, j] = drives[j].motor(q[:, j])
    return replace(record, q=q, motor=motor)


def with_errors(
    rows: Sequence[Rows], periods: Sequence[int | None], evaluator: Evaluator, model: Model, theta: Array
) -> tuple[list[Rows], Array]:
    """The rows with what errors of the positions leave where that repeats, and its mean squares where it
    repeats or not, by joint (n,), inputs squared.
    """
    which = repeating_errors(rows, periods)
    total, found = np.zeros(len(which)), []
    for r in rows:
        every = _left_by_errors(r, evaluator, model, theta)
        total += (every**2 * r.moving).sum(axis=0)
        some = None
        if which.any():
            some = every if which.all() else _left_by_errors(r, evaluator, model, theta, which)
        found.append(replace(r, repeated=some))
    return found, np.asarray(total / np.maximum(moving_rows(rows), 1.0))


def _left_by_errors(
    r: Rows, evaluator: Evaluator, model: Model, theta: Array, which: NDArray[np.bool_] | None = None
) -> Array:
    """A draw of what errors of the positions leave in a record's residuals (M, n). which: as of `blurred`."""
    p = r.prepared
    if not counts(p.record).any():
        return np.zeros(r.effort.shape)
    blurry = replace(prepare(blurred(p.record, which), p.settings), awake=p.awake)
    again = rows_of(evaluator, model, blurry, theta, r.baseline)
    return np.asarray((again.effort - r.effort) - (again.columns - r.columns) @ theta)


def repeating_errors(rows: Sequence[Rows], periods: Sequence[int | None]) -> NDArray[np.bool_]:
    """Whether the errors of stepped positions are the same in every period, by joint (n,).

    Readings that differ by less than half a count, in the root mean square, are rounded alike: of independent
    errors the steps alone make 0.41 counts, and a motion that differs by a third of a count more than half.
    """
    n = rows[0].effort.shape[1]
    total, count = np.zeros(n), 0
    for r, period in zip(rows, periods, strict=True):
        record, size = r.prepared.record, counts(r.prepared.record)
        if period is None or period >= len(r.prepared.rows):
            continue
        read = np.column_stack([_logged(record, j) for j in range(n)])[r.prepared.rows]
        change = (read[period:] - read[:-period]) / np.where(size > 0, size, np.inf)
        total += np.where(size > 0, (change**2).sum(axis=0), np.inf)
        count += len(change)
    return np.asarray(total < ALIKE**2 * count)


def harmless(rows: Sequence[Rows], blur: Array, squares: Array, least: float) -> bool:
    """Whether the errors of the positions are known, and could feign no gain of `least` percent.

    blur, squares: as of `feigned`.
    """
    return bool(feigned(blur, squares).max() <= least) and all(rounded(r.prepared.record) for r in rows)


def feigned(blur: Array, squares: Array) -> Array:
    """Percent of the RMSE that a column could gain by following the errors of the positions alone.

    squares: mean squares of the residuals by joint, as blur.
    """
    share = np.clip(blur / np.maximum(squares, 1e-300), 0.0, 1.0)
    return np.asarray(100.0 * (1.0 - np.sqrt(1.0 - share)))
