"""How far the noise of the positions can feign a cause.

Regressors are made of measured positions; where a coarse encoder blurs them, least squares correlates
columns with their own errors (Fuller 1987, "Measurement Error Models", 1.1). What the error of the
regressor leaves in the residuals is measured by rounding the motion once more in the same way and
looking at what that changes (Cook and Stefanski 1994). No column can gain more by following that error
than the error's whole share of the residuals: a gain up to that share is no evidence.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset import Prepared, Record, drives_of, prepare
from modelgen.dataset.processing.content import white_noise
from modelgen.diagnosis.equations.effort_errors import left_by_rounded_efforts
from modelgen.diagnosis.equations.equations import Equations
from modelgen.diagnosis.equations.rows import Rows
from modelgen.diagnosis.options.thresholds import EquationThresholds
from modelgen.numeric import Array
from modelgen.regression.weighted import moving_rows

SEED = 19940801  # of the draw of errors
THIRD = 20.0 / 12.0  # mean square of the third differences of rounding errors, counts squared


def counts(record: Record, limits: EquationThresholds) -> Array:
    """Resolution of the logged positions by coordinate, (n,), in the unit that was logged; 0: not stepped."""
    return np.array([_count(_logged(record, j), limits) for j in range(record.n)])


def _logged(record: Record, j: int) -> Array:
    motor = bool(record.motor_side) and record.motor_side[j]
    return (record.motor if motor else record.q)[:, j]


def _count(values: Array, limits: EquationThresholds) -> float:
    """The smallest step of which all others are multiples."""
    steps = np.abs(np.diff(values))
    steps = steps[steps > 1e-12 * max(float(np.ptp(values)), 1e-300)]
    if len(steps) < limits.min_position_steps:
        return 0.0
    smallest = float(steps.min())
    near = steps[steps < limits.near_step_ratio * smallest]
    count = float(near.mean())
    off = np.abs(steps / count - np.round(steps / count))[steps < limits.small_step_counts * count]
    least = float(np.quantile(off, limits.whole_steps_share))
    return count if least < limits.max_count_deviation else 0.0


def rounded(record: Record, limits: EquationThresholds) -> NDArray[np.bool_]:
    """Whether rounding to counts is all the error that the logged positions have, by coordinate (n,).

    By their third differences, in which a motion that is sampled well all but vanishes.
    """
    found = []
    for j, count in enumerate(counts(record, limits)):
        most = limits.max_rounding_error**2 * THIRD * count**2
        found.append(count > 0 and float(np.mean(np.diff(_logged(record, j), 3) ** 2)) <= most)
    return np.array(found)


def blurred(prepared: Prepared, limits: EquationThresholds, which: NDArray[np.bool_] | None = None) -> Record:
    """The record with one more error like its own on every position.

    Where rounding is all the error that it has, the error of another rounding of the same motion: with the
    counts shifted by a part of one. A motion that takes many samples for a count keeps its error as long,
    and low frequencies hold more of it than of errors that are drawn sample by sample, as they are where
    other noise moves the readings: white, and as large as their spectrum shows above the motion, in free
    motions as large as a count. which: of these coordinates (n,) alone.
    """
    record = prepared.record
    random = np.random.default_rng(SEED)
    q, motor = record.q.copy(), record.motor.copy()
    drives = drives_of(record.arm) if record.arm is not None else ()
    alone = rounded(record, limits)
    for j, count in enumerate(counts(record, limits)):
        if which is not None and not which[j]:
            continue
        side = bool(record.motor_side) and record.motor_side[j]
        motion = (prepared.motor if side else prepared.q)[:, j]
        if alone[j]:
            shifted = motion / count + random.uniform()
            error = (np.round(shifted) - shifted) * count
        elif record.input is None:  # other noise of a free motion is all that its equations leave
            error = random.uniform(-0.5, 0.5, len(q)) * count
        else:
            error = random.normal(0.0, white_noise(_logged(record, j), 1.0 / record.step), len(q))
        if side:
            motor[:, j] += error
        else:
            q[:, j] += error
            if drives:
                motor[:, j] = drives[j].motor(q[:, j])
    return replace(record, q=q, motor=motor)


def with_errors(equations: Equations, theta: Array) -> Equations:
    """The equations with what errors of positions and efforts leave where that repeats, and with its mean
    squares, those of the positions where they do not repeat too. theta: unknowns (k,) of a first fit.
    """
    which = repeating_errors(equations)
    total, efforts, found = np.zeros(len(which)), np.zeros(len(which)), []
    for r, period in zip(equations.rows, equations.periods, strict=True):
        every = _left_by_errors(r, equations, theta)
        total += (every**2 * r.moving).sum(axis=0)
        some = left_by_rounded_efforts(r, period, equations, theta)
        if some is not None:
            efforts += (some**2 * r.moving).sum(axis=0)
        if which.any():
            of_positions = every if which.all() else _left_by_errors(r, equations, theta, which)
            some = of_positions if some is None else some + of_positions
        found.append(replace(r, repeated=some))
    moving = np.maximum(moving_rows(equations.rows), 1.0)
    blur, stepped = (total + efforts) / moving, efforts / moving
    return replace(equations, rows=found, blur=blur, stepped=stepped)


def _left_by_errors(
    r: Rows, equations: Equations, theta: Array, which: NDArray[np.bool_] | None = None
) -> Array:
    """A draw of what errors of the positions leave in a record's residuals (M, n). which: as of `blurred`."""
    p, limits = r.prepared, equations.thresholds.equations
    if p.input is None and not counts(p.record, limits).any():
        return np.zeros(r.effort.shape)
    return left_by_reading(blurred(p, limits, which), r, equations, theta)


def left_by_reading(record: Record, r: Rows, equations: Equations, theta: Array) -> Array:
    """What another reading of a record's motion leaves in its residuals, (M, n). theta: unknowns (k,)."""
    own = r.prepared
    read = replace(prepare(record, own.settings), awake=own.awake, before=own.before)
    again = equations.of_record(read, theta)
    return np.asarray((again.effort - r.effort) - (again.columns - r.columns) @ theta)


def repeating_errors(equations: Equations) -> NDArray[np.bool_]:
    """Whether the errors of stepped positions are the same in every period, by joint (n,).

    Readings that differ by less than `max_repeated_difference`, in the root mean square, are rounded alike.
    """
    limits = equations.thresholds.equations
    n = equations.n
    total, count = np.zeros(n), 0
    for r, period in zip(equations.rows, equations.periods, strict=True):
        record, size = r.prepared.record, counts(r.prepared.record, limits)
        if period is None or period >= len(r.prepared.rows):
            continue
        read = np.column_stack([_logged(record, j) for j in range(n)])[r.prepared.rows]
        change = (read[period:] - read[:-period]) / np.where(size > 0, size, np.inf)
        total += np.where(size > 0, (change**2).sum(axis=0), np.inf)
        count += len(change)
    return np.asarray(total < limits.max_repeated_difference**2 * count)


def harmless(equations: Equations, squares: Array) -> bool:
    """Whether the errors of the positions could feign no gain that is worth naming.

    squares: mean squares of the residuals by joint (n,).
    """
    return bool(feigned(equations.blur, squares).max() <= equations.thresholds.validation.min_gain_percent)


def feigned(blur: Array, squares: Array) -> Array:
    """Percent of the RMSE that a column could gain by following the errors of the positions alone.

    squares: mean squares of the residuals by joint, as blur.
    """
    share = np.clip(blur / np.maximum(squares, 1e-300), 0.0, 1.0)
    return np.asarray(100.0 * (1.0 - np.sqrt(1.0 - share)))
