"""Identical periods of a record: they show what is noise, because the motion repeats and it does not."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset.objects import Record
from modelgen.dataset.processing.settings import Chosen
from modelgen.dataset.thresholds import USUAL, DatasetThresholds
from modelgen.errors import InputError
from modelgen.numeric import Array

# A whole number of samples is the period where positions differ after it by so many times the least.
WHOLE = 2.0
FARTHEST = 20  # periods over which a part of a sample is told
OFF = 0.25  # of a sample, by which a whole number may be off over a record
BESIDE = 0.1  # of a sample a period, by which rows may drift from the same phase
PIECES = 16  # of a record, of which the first ones may not repeat
SETTLED = 1e-4  # of the power, by which a sample may differ from that a period later
ALIKE = 2.0  # times the most in the last period, by which it may as well
LATER = 3  # periods, of which the first one says nothing of how long they are
CLOSE = 1e-3  # of a period, by which one that is found may be off
CONTRADICTED = 10.0  # times what positions differ by after a period that is found
SHORT = 0.05  # of a period, by which the last one may be shorter than it is
FEWEST = 4  # samples a row, so that half a sample of a row's place is little


def period_of(record: Record, given: float | None, limits: DatasetThresholds = USUAL) -> float | None:
    """Samples in a period of the motion, as given [s] or the first lag at which all positions repeat.

    A whole number where one does over the whole record. None where the record does not hold two whole
    periods, or nothing repeats. Raises InputError for a given period that is none.
    """
    if given is not None:
        return _checked(record, given, limits)
    if record.period is not None:
        return record.period if _holds_two(record, record.period) else None
    count = len(record.t)
    coarse = max(1, count // 3000)
    q = record.q[::coarse] - record.q.mean(axis=0)
    scale = np.maximum((q**2).mean(axis=0), 1e-300)
    lags = np.arange(max(3, len(q) // 60), len(q) // 2 + 1)
    errors = np.array([_unlike(q, int(lag), scale) for lag in lags])
    good = np.flatnonzero(errors < limits.max_period_difference)
    if len(good) and not good[0]:
        # Where positions differ no more after any shorter time, it is that they hardly move in it.
        shorter = [_unlike(q, lag, scale) for lag in range(1, int(lags[0]))]
        if max(shorter, default=0.0) < limits.max_period_difference:
            good = good[np.cumprod(good == np.arange(len(good))) == 0]
    if not len(good):
        return None
    # the first valley: its multiples repeat as well
    last = good[0]
    for k in good:
        if k > last + 1:
            break
        last = k
    valley = good[(good >= good[0]) & (good <= last)]
    about = int(lags[valley[np.argmin(errors[valley])]]) * coarse
    near = range(max(1, about - 2 * coarse), min(about + 2 * coarse, count // 2) + 1)
    # An arm may still be on its way into the motion in the first of several periods.
    later = record.q[about:] if count >= LATER * about else record.q
    exact = [_differs(later, lag) for lag in near]
    return _between(record.q, near[int(np.argmin(exact))])


def _holds_two(record: Record, period: float) -> bool:
    """Whether a record holds two periods [samples], but for a sample."""
    return 2 * period <= len(record.t) + 1


def repetition(
    record: Record, given: float | None = None, limits: DatasetThresholds = USUAL
) -> tuple[int, float] | None:
    """First sample from which the motion repeats, and samples in a period of it; None where nothing does.

    A beginning that does not repeat, on the way into the motion, is shorter than a period. given: period [s].
    Raises InputError for a given period that is none.
    """
    period: float | None = None
    refused: InputError | None = None
    try:
        period = period_of(record, given, limits)
    except InputError as error:  # of a given period, which what comes later may have
        refused = error
    if period is not None:  # a given one may be missed by more than noise makes
        found = None if given is None else period_of(record, None, limits)
        begin = 0 if given is None or _same(found, period) else _settled(record.q, round(period))
        later = period_of(record.part(begin, len(record.t)), given, limits) if begin else None
        return (0, period) if later is None else (begin, later)
    count = len(record.t)
    for end in range(count // PIECES, count // 2 + 1, max(1, count // PIECES)):
        with suppress(InputError):
            period = period_of(record.part(end, count), given, limits)
        if period is not None:
            break
    else:
        if refused is not None:
            raise refused
        return None
    begin = _settled(record.q, round(period), end)
    period = period_of(record.part(begin, count), given, limits)
    return None if period is None else (begin, period)


def whole_periods(count: int, period: float) -> int:
    """How many periods [samples] so many samples have, the last one but for a little of it."""
    return int(max(count + 1, count + SHORT * period) / period)


def _same(found: float | None, period: float) -> bool:
    """Whether a period that was found is one [samples] that was given."""
    return found is not None and abs(found - period) <= max(1.0, CLOSE * period)


def _settled(q: Array, lag: int, end: int = 0) -> int:
    """First sample from which positions (N, n) repeat after a lag; `end`: one by which they do."""
    power = np.maximum(2 * q[end:].var(axis=0), 1e-300)
    differing = (((q[lag:] - q[:-lag]) ** 2) / power).max(axis=1)
    other = np.flatnonzero(differing[:lag] > max(SETTLED, ALIKE * differing[-lag:].max()))
    return int(other[-1]) + 1 if len(other) else 0


def _unlike(q: Array, lag: int, scale: Array) -> float:
    """Mean square by which positions (N, n) differ after a lag, over twice their scale (n,), the largest."""
    return float((((q[lag:] - q[:-lag]) ** 2).mean(axis=0) / (2 * scale)).max())


def _differs(q: Array, lag: int) -> float:
    """Mean square by which positions (N, n) differ after a lag, the geometric mean over the joints.

    It is least at the likeliest lag where each joint differs by a noise of its own size: a joint that sticks
    elsewhere in each period does not say when the others repeat.
    """
    squares = ((q[lag:] - q[:-lag]) ** 2).mean(axis=0)
    return float(np.exp(np.log(np.maximum(squares, 1e-300)).mean()))


def _between(q: Array, lag: int) -> float:
    """Samples in a period, about `lag`: as many periods as fit, within a part of a sample, by that number.

    The whole number itself where after all those periods the positions differ by hardly more than at best.
    """
    periods = min(FARTHEST, max(1, (len(q) * 3 // 4) // lag))
    far = range(periods * lag - periods, min(periods * lag + periods, len(q) - 2) + 1)
    if len(far) < 3:
        return lag
    errors = [_differs(q, k) for k in far]
    best = int(np.argmin(errors))
    if best in (0, len(far) - 1) or errors[periods] <= WHOLE * errors[best]:
        return lag
    before, least, after = errors[best - 1 : best + 2]
    bend = before - 2 * least + after
    place = far[best] + (0.5 * (before - after) / bend if bend > 0 else 0.0)
    return place / periods


def _checked(record: Record, given: float, limits: DatasetThresholds) -> float | None:
    """Samples in a given period [s]; None where the record does not hold two of them."""
    shortest, loose = limits.min_period_samples, limits.max_given_period_difference
    if not (math.isfinite(given) and given >= shortest * record.step):
        raise InputError(
            f"--period: found {given:g} s, expected at least {shortest} samples of {record.name}, "
            f"{shortest * record.step:.3g} s"
        )
    lag = round(min(given / record.step, len(record.t)))
    if not _holds_two(record, lag):
        return None
    differs = float(_differing(record.q, lag)[_differing(record.q, 1) < loose].max(initial=0.0))
    found = period_of(record, None, limits)
    if differs > loose:
        hint = "leave it out" if found is None else f"found is {found * record.step:.6g} s"
        raise InputError(
            f"--period: {record.name} does not repeat after {given:g} s: its positions differ by "
            f"{100 * differs:.2g} % of their power, expected {100 * loose:g} % at most; {hint}"
        )
    if found is not None and (times := max(1, round(lag / found))) * found <= len(record.t) / 2:
        at_best = _differs(record.q, round(times * found))
        if _differs(record.q, lag) > CONTRADICTED * at_best and not _same(times * found, lag):
            raise InputError(
                f"--period: {record.name} repeats after {times * found * record.step:.6g} s, not nearly as "
                f"well after {given:g} s; expected the former, or leave it out"
            )
    exact = given / record.step
    return lag if abs(exact - lag) * len(record.t) / lag < OFF else exact


def _differing(q: Array, lag: int) -> Array:
    """Share of the power of positions (N, n) that differs after a lag, (n,); noise does after one."""
    power = np.maximum(2 * q.var(axis=0), 1e-300)
    return np.asarray(((q[lag:] - q[:-lag]) ** 2).mean(axis=0) / power)


def with_whole_rows(chosen: Chosen, periods: Sequence[float | None]) -> Chosen:
    """The settings with a decimation that puts the same phases of every period on rows.

    Every factor-th sample where that does, else the samples nearest to a whole number of places in a period,
    the first one that is known: a low-pass that leaves many samples a row makes no more of half a sample.
    """
    known = [p for p in periods if p is not None]
    if not known:
        return chosen
    for factor in range(chosen.factor, max(0, chosen.factor // 2), -1):
        if factor > 0 and all(p % factor == 0 for p in known):
            return replace(chosen, factor=factor)
    if chosen.factor < FEWEST:
        return chosen
    return replace(chosen, spacing=known[0] / math.ceil(known[0] / chosen.factor))


def rows_in(period: float | None, chosen: Chosen) -> int | None:
    """Rows in a period [samples]; None where it does not repeat, or not on whole rows."""
    if period is None:
        return None
    rows = period / chosen.stride
    drift = abs(rows - round(rows)) * chosen.stride
    return round(rows) if drift < BESIDE else None


def folded(values: NDArray[np.float64], rows: int) -> Array:
    """Values (M,) of a record, one line of `rows` a period; nan after the end."""
    periods = -(-len(values) // rows)
    table = np.full(periods * rows, np.nan)
    table[: len(values)] = values
    return table.reshape(periods, rows)


def by_phase(table: Array) -> tuple[Array, Array, NDArray[np.int64]]:
    """Of values, a line a period and nan where there is none, at each phase (rows,): squares of their mean
    times their number, squares of what differs from it, and their number, 0 where fewer than two are there.
    """
    there = np.isfinite(table)
    count = there.sum(axis=0)
    full = count >= 2
    values, k = np.where(there & full, table, 0.0), np.where(full, count, 0)
    mean = values.sum(axis=0) / np.maximum(k, 1)
    within = np.where(there & full, values - mean, 0.0)
    return k * mean**2, (within**2).sum(axis=0), k


def noise_of(values: Array, usable: NDArray[np.bool_], rows: int) -> tuple[Array, NDArray[np.bool_]]:
    """Values (M,) less their mean over periods at the same phase, with the variance of the noise.

    The flags say where at least two usable periods made the mean.
    """
    table = folded(np.where(usable, values, np.nan), rows)
    there = np.isfinite(table)
    count = there.sum(axis=0)
    mean = np.where(count > 0, np.nansum(table, axis=0) / np.maximum(count, 1), np.nan)
    with np.errstate(invalid="ignore", divide="ignore"):
        scale = np.sqrt(count / np.maximum(count - 1, 1))
        left = (table - mean) * scale
    flags = there & (count >= 2)
    return np.where(flags, left, 0.0).ravel()[: len(values)], flags.ravel()[: len(values)]


def other_period(count: int, rows: int) -> NDArray[np.int64]:
    """For each of `count` rows one at the same phase of the next period, else of the one before, else -1."""
    i = np.arange(count)
    behind = np.where(i >= rows, i - rows, -1)
    return np.where(i + rows < count, i + rows, behind)
