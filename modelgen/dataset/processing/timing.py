"""Time axes: their order, their gaps, and the uniform axis of a record, found in one pass over a log."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from scipy.ndimage import median_filter

from modelgen.dataset.thresholds import USUAL, DatasetThresholds
from modelgen.errors import InputError
from modelgen.numeric import Array


@dataclass(frozen=True)
class Axis:
    """The uniform time axis begin + k step [s], k = 0 to count - 1, of a whole log.

    jitter: largest deviation of the time between two samples from the period, in periods. method: how
    signals get there: "none" (sample k stays sample k), "spline", "monotone" or "mean".
    """

    begin: float
    step: float
    count: int
    jitter: float
    method: str

    def times(self, first: int = 0, end: int | None = None) -> Array:
        """Times of the samples first to end (excluded) [s]."""
        numbers = np.arange(first, self.count if end is None else end, dtype=np.float64)
        return self.begin + self.step * numbers


_BESIDE = 15  # steps, whose median is the usual one there: no single late sample
_LOOKED_AT = 4096  # of them per block
_SELDOM = 0.05  # of the time, that a log may be slower than its axis
_ALIKE = 1.2  # times as long are steps of one rate


@dataclass
class Survey:
    """Statistics of a log's stamps, gathered block by block.

    rate: of the uniform axis [Hz], gap: longest time without a sample [s], where they are prescribed.
    """

    file: str
    rate: float | None = None
    gap: float | None = None
    limits: DatasetThresholds = USUAL
    period: float = 0.0  # median of the first block
    count: int = 0
    last: float = 0.0
    jitter: float = 0.0
    ends: list[tuple[int, float]] = field(default_factory=list)  # number and time of the blocks' ends
    bends: list[float] = field(default_factory=list)  # largest distance of a block's stamps from their chord
    usual: list[Array] = field(default_factory=list)  # steps that are usual where they are, of some samples

    def add(self, stamps: Array) -> None:
        """The next stamps (N,). Raises InputError where time does not run, or where there is a gap."""
        before = [] if self.count == 0 else [self.last]
        line = np.concatenate([before, stamps])
        steps = np.diff(line)
        wrong = np.flatnonzero(steps <= 0.0)
        if wrong.size:
            k = int(wrong[0])
            what, hint = "runs backwards", ""
            if steps[k] == 0.0:
                what = "stands still"
                hint = "; where rows are evenly spaced, `rate:` in a mapping file (--mapping) counts them"
            raise InputError(
                f"{self.file}: time {what} after t = {line[k]:.9g} s: "
                f"the next stamp is {line[k + 1]:.9g} s{hint}"
            )
        if self.period == 0.0 and steps.size:
            self.period = float(np.median(steps))
        longest = self.limits.max_gap_periods * self.period if self.gap is None else self.gap
        if steps.size and steps.max() > longest:
            k = int(np.argmax(steps > longest))
            raise InputError(
                f"{self.file}: found a gap of {steps[k]:.4g} s after t = {line[k]:.9g} s, expected at most "
                f"{longest:.4g} s between samples; use the parts beside it, FILE@t0:t1, or set "
                "time: {largest_gap: ...} in a mapping file (--mapping)"
            )
        if steps.size:
            self.jitter = max(self.jitter, float(np.max(np.abs(steps - self.period))) / self.period)
        if len(steps) >= _BESIDE:
            self.usual.append(median_filter(steps, _BESIDE, mode="nearest")[:: 1 + len(steps) // _LOOKED_AT])
        if not self.ends:
            self.ends.append((0, float(stamps[0])))
        chord = np.linspace(line[0], line[-1], len(line))
        self.bends.append(float(np.max(np.abs(line - chord))))
        self.count += len(stamps)
        self.last = float(stamps[-1])
        self.ends.append((self.count - 1, self.last))

    def axis(self) -> Axis:
        """The uniform axis of the stamps seen."""
        (_, begin), (number, end) = self.ends[0], self.ends[-1]
        if self.rate is None:
            step = (end - begin) / number
            drift = max(abs(t - begin - k * step) for k, t in self.ends)
            if drift + max(self.bends) <= self.limits.max_jitter * self.period:
                return Axis(begin, step, self.count, self.jitter, "none")
            step = self._slowest()
        else:
            step = 1.0 / self.rate
        count = int(np.floor((end - begin) / step * (1.0 + 1e-12))) + 1
        even = "spline" if self.jitter < self.limits.max_spline_jitter else "monotone"
        averaged = step > self.limits.averaging_step * self.period
        return Axis(begin, step, count, self.jitter, "mean" if averaged else even)

    def _slowest(self) -> float:
        """Steps [s] of the slowest rate that a log has for long: what is read more often is averaged, for
        nobody knows what was between samples where they are fewer.
        """
        usual = np.sort(np.concatenate(self.usual)) if self.usual else np.empty(0)
        if not len(usual):
            return self.period
        slow = usual[np.searchsorted(np.cumsum(usual), (1.0 - _SELDOM) * usual.sum())]
        if slow < self.limits.averaging_step * self.period:
            return self.period
        return float(np.median(usual[(usual > slow / _ALIKE) & (usual < slow * _ALIKE)]))


def survey(found: Survey, stamps: Array, block: int) -> Axis:
    """The uniform axis of stamps (N,) [s], `block` at a time. Raises InputError as Survey does."""
    for begin, end in pairwise([*range(0, len(stamps), block), len(stamps)]):
        found.add(stamps[begin:end])
    return found.axis()
