"""What repeats from period to period is not noise: the pure-error test of lack of fit.

With k periods of the excitation, the mean residual over periods has the variance of the noise over k
where the model is complete; what it has beyond that is deterministic (Draper and Smith 1998, 1.5;
Swevers, Verdonck and De Schutter 2007 for periodic excitation).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from modelgen.diagnosis.rows import Array, Rows
from modelgen.diagnosis.system import System

SIGNIFICANCE = 1e-3  # of a false alarm, all joints together
INFLATION = 1.12  # of the threshold, for what the whitening leaves of colour; from null records


@dataclass(frozen=True)
class LackOfFit:
    """statistic, threshold: of the joint that exceeds its threshold by most. by_joint: (n,) statistics."""

    statistic: float
    threshold: float
    by_joint: Array
    periods: int

    @property
    def found(self) -> bool:
        """Whether something deterministic is left."""
        return self.statistic > self.threshold


def period_of(rows: Rows, given: float | None) -> float | None:
    """Period of the motion [s]: as given, or the lag at which every joint's position repeats best.

    None where the record does not hold two whole periods, or nothing repeats to a thousandth of its power.
    """
    p = rows.prepared
    duration = float(p.time[-1] - p.time[0])
    if given is not None:
        return given if 2 * given <= duration + p.record.step else None
    step = max(1, len(p.time) // 4000)
    q = p.q[::step] - p.q.mean(axis=0)
    dt = p.record.step * step
    best: tuple[float, int] = (np.inf, 0)
    count = len(q)
    power = float((q**2).mean())
    previous = np.inf
    falling = False
    for lag in range(max(2, count // 50), count // 2 + 1):
        error = float(((q[lag:] - q[:-lag]) ** 2).mean()) / (2 * power)
        if error > previous and falling and previous < 2e-3 and previous < 0.5 * best[0]:
            best = (previous, lag - 1)
            break  # the first lag at which all repeats: the others are its multiples
        falling = error < previous
        previous = error
    else:
        if falling and previous < 2e-3:
            best = (previous, count // 2)
    return None if best[1] == 0 else _refined(p.q, p.record.step, best[1] * dt, dt)


def _refined(q: Array, step: float, about: float, width: float) -> float:
    """The period to a sample of the record."""
    lags = range(max(1, round((about - width) / step)), round((about + width) / step) + 1)
    errors = [float(((q[lag:] - q[:-lag]) ** 2).mean()) for lag in lags]
    return lags[int(np.argmin(errors))] * step


def lack_of_fit(system: System, rows: Sequence[Rows], period: float | None) -> LackOfFit | None:
    """Of the whitened residual of the training records; None where nothing repeats."""
    n = system.n
    between, within = np.zeros(n), np.zeros(n)
    free_between, free_within = np.zeros(n), np.zeros(n)
    most = 0
    for i, r in enumerate(rows):
        length = period_of(r, period)
        if length is None:
            continue
        per = length * r.prepared.rate
        for j in range(n):
            white = np.full(len(r.effort), np.nan)
            chosen = (system.record == i) & (system.joint == j)
            white[system.usable[i][:, j]] = system.left[chosen]
            table = _folded(white, per)
            most = max(most, len(table))
            counts = np.isfinite(table).sum(axis=0)
            full = counts >= 2
            if not full.any():
                continue
            part, k = table[:, full], counts[full]
            mean = np.nanmean(part, axis=0)
            between[j] += float((k * mean**2).sum())
            free_between[j] += full.sum()
            within[j] += float(np.nansum((part - mean) ** 2))
            free_within[j] += (k - 1).sum()
    if not (free_within > 10).any():
        return None
    # the fit has taken as many degrees of freedom from the mean as it has parameters
    free_between = np.maximum(1.0, free_between - system.basis.shape[1] / n)
    with np.errstate(invalid="ignore", divide="ignore"):
        statistic = np.where(free_within > 10, (between / free_between) / (within / free_within), 0.0)
    limits = np.array(
        [
            INFLATION * stats.f.ppf(1 - SIGNIFICANCE / n, a, b) if b > 10 else np.inf
            for a, b in zip(free_between, free_within, strict=True)
        ]
    )
    worst = int(np.argmax(statistic / limits))
    return LackOfFit(float(statistic[worst]), float(limits[worst]), statistic, most)


def _folded(values: NDArray[np.float64], per: float) -> Array:
    """Values of one record, one line a period, at the phases of the rows of the first."""
    phases = int(per)
    periods = int((len(values) - 1) // per)
    if periods < 1:
        return np.full((1, 1), np.nan)
    places = np.arange(phases)
    lines = []
    for k in range(periods + 1):
        at = k * per + places
        inside = at <= len(values) - 1
        low = np.minimum(at.astype(int), len(values) - 1)
        high = np.minimum(low + 1, len(values) - 1)
        share = at - low
        # between rows both neighbours count; the variance lost by that is the same in every period but
        # the first, and rows fall on phases where the period is a whole number of them
        line = np.where(share < 1e-6, values[low], (1 - share) * values[low] + share * values[high])
        lines.append(np.where(inside, line, np.nan))
    return np.array(lines)
