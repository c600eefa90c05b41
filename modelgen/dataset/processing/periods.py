"""Identical periods of a record: they show what is noise, because the motion repeats and it does not."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset.objects import Record
from modelgen.dataset.processing.settings import Chosen
from modelgen.dataset.thresholds import USUAL, DatasetThresholds
from modelgen.errors import InputError
from modelgen.numeric import Array


def period_of(record: Record, given: float | None, limits: DatasetThresholds = USUAL) -> int | None:
    """Samples in a period of the motion, as given [s] or the first lag at which all positions repeat.

    None where the record does not hold two whole periods, or nothing repeats. Raises InputError for a given
    period that is none.
    """
    if given is not None:
        return _checked(record, given, limits)
    count = len(record.t)
    coarse = max(1, count // 3000)
    q = record.q[::coarse] - record.q.mean(axis=0)
    scale = np.maximum((q**2).mean(axis=0), 1e-300)
    lags = np.arange(max(3, len(q) // 60), len(q) // 2 + 1)
    errors = np.array([(((q[lag:] - q[:-lag]) ** 2).mean(axis=0) / (2 * scale)).max() for lag in lags])
    good = np.flatnonzero(errors < limits.max_period_difference)
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
    exact = [float(((record.q[lag:] - record.q[:-lag]) ** 2).mean()) for lag in near]
    return near[int(np.argmin(exact))]


def _checked(record: Record, given: float, limits: DatasetThresholds) -> int | None:
    """Samples in a given period [s]; None where the record does not hold two of them."""
    shortest, loose = limits.min_period_samples, limits.max_given_period_difference
    if not (math.isfinite(given) and given >= shortest * record.step):
        raise InputError(
            f"--period: found {given:g} s, expected at least {shortest} samples of {record.name}, "
            f"{shortest * record.step:.3g} s"
        )
    lag = round(min(given / record.step, len(record.t)))
    if 2 * lag > len(record.t) + 1:
        return None
    differs = float(_differing(record.q, lag)[_differing(record.q, 1) < loose].max(initial=0.0))
    if differs > loose:
        found = period_of(record, None, limits)
        hint = "leave it out" if found is None else f"found is {found * record.step:.6g} s"
        raise InputError(
            f"--period: {record.name} does not repeat after {given:g} s: its positions differ by "
            f"{100 * differs:.2g} % of their power, expected {100 * loose:g} % at most; {hint}"
        )
    return lag


def _differing(q: Array, lag: int) -> Array:
    """Share of the power of positions (N, n) that differs after a lag, (n,); noise does after one."""
    power = np.maximum(2 * q.var(axis=0), 1e-300)
    return np.asarray(((q[lag:] - q[:-lag]) ** 2).mean(axis=0) / power)


def with_whole_rows(chosen: Chosen, periods: Sequence[int | None]) -> Chosen:
    """The settings with a decimation that puts the same phases of every period on rows."""
    known = [p for p in periods if p is not None]
    if not known:
        return chosen
    for factor in range(chosen.factor, max(0, chosen.factor // 2), -1):
        if factor > 0 and all(p % factor == 0 for p in known):
            return replace(chosen, factor=factor)
    return chosen


def folded(values: NDArray[np.float64], rows: int) -> Array:
    """Values (M,) of a record, one line of `rows` a period; nan after the end."""
    periods = -(-len(values) // rows)
    table = np.full(periods * rows, np.nan)
    table[: len(values)] = values
    return table.reshape(periods, rows)


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
