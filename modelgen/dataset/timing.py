"""Time axes: their order, their gaps, and records on a uniform one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator

from modelgen.dataset.objects import Array
from modelgen.errors import InputError

JITTER = 0.02  # of the period; below it the stamps are taken as uniform
UNEVEN = 0.5  # of the period; above it splines ring
GAP = 10.0  # periods without a sample


@dataclass(frozen=True)
class Axis:
    """A uniform time axis t (N,) [s], and how far the stamps were from one.

    jitter: largest deviation of the time between two samples from the median, in medians.
    """

    t: Array
    jitter: float
    resampled: bool

    @property
    def step(self) -> float:
        """Sampling period [s]."""
        return float(self.t[-1] - self.t[0]) / (len(self.t) - 1)


def uniform_axis(file: str, stamps: Array, rate: float | None = None, gap: float | None = None) -> Axis:
    """The uniform axis for stamps (N,) [s].

    rate: [Hz], by default one over the median period. gap: longest time without a sample that is
    accepted [s], by default ten periods. Raises InputError where time stands still or runs backwards.
    """
    steps = np.diff(stamps)
    wrong = np.flatnonzero(steps <= 0.0)
    if wrong.size:
        k = int(wrong[0])
        what = "stands still" if steps[k] == 0.0 else "runs backwards"
        raise InputError(
            f"{file}: time {what} after t = {stamps[k]:.9g} s: the next stamp is {stamps[k + 1]:.9g} s"
        )
    period = float(np.median(steps))
    longest = GAP * period if gap is None else gap
    k = int(np.argmax(steps))
    if steps[k] > longest:
        raise InputError(
            f"{file}: found a gap of {steps[k]:.4g} s after t = {stamps[k]:.9g} s, expected at most "
            f"{longest:.4g} s between samples; use the parts beside it, FILE@t0:t1, or set "
            "time: {largest_gap: ...} in a mapping file (--mapping)"
        )
    jitter = float(np.max(np.abs(steps - period))) / period
    if rate is None:
        even = np.linspace(stamps[0], stamps[-1], len(stamps))
        if float(np.max(np.abs(stamps - even))) <= JITTER * period:
            return Axis(even, jitter, False)
        rate = 1.0 / period
    count = int(np.floor((stamps[-1] - stamps[0]) * rate * (1.0 + 1e-12))) + 1
    return Axis(stamps[0] + np.arange(count) / rate, jitter, True)


def smooth_resampled(stamps: Array, values: Array, t: Array) -> Array:
    """A continuous signal (N, k) at other times (M,).

    By cubic splines where the stamps are nearly even; by monotone cubics (PCHIP), which do not ring, where
    they are not; by means of the broken line around each time where the new axis is coarser.
    """
    steps = np.diff(stamps)
    period, step = float(np.median(steps)), float(t[-1] - t[0]) / (len(t) - 1)
    if step > 1.5 * period:
        return _means(stamps, values, t, step)
    even = float(np.max(np.abs(steps - period))) < UNEVEN * period
    curve = CubicSpline(stamps, values) if even else PchipInterpolator(stamps, values)
    return np.asarray(curve(t), dtype=np.float64)


def _means(stamps: Array, values: Array, t: Array, step: float) -> Array:
    """Mean of the broken line through values (N, k) over each [t - step/2, t + step/2] within the stamps."""
    low = np.clip(t - 0.5 * step, stamps[0], stamps[-1])
    high = np.clip(t + 0.5 * step, stamps[0], stamps[-1])
    knots = np.unique(np.concatenate([stamps, low, high]))
    result = np.empty((len(t), values.shape[1]))
    for k, column in enumerate(values.T):
        line = np.interp(knots, stamps, column)
        area = np.concatenate([[0.0], np.cumsum(0.5 * (line[1:] + line[:-1]) * np.diff(knots))])
        result[:, k] = (np.interp(high, knots, area) - np.interp(low, knots, area)) / (high - low)
    return result


def held_resampled(stamps: Array, values: Array, t: Array) -> Array:
    """A signal (N, k) that is constant from each stamp to the next: its mean over each period of t.

    The mean over [t, t + step] keeps the effort's integral, so that no delay and no bias come in.
    """
    step = (t[-1] - t[0]) / (len(t) - 1)
    widths = np.diff(stamps, append=stamps[-1] + max(step, float(np.median(np.diff(stamps)))))
    integral = np.vstack([np.zeros((1, values.shape[1])), np.cumsum(values * widths[:, None], axis=0)])
    knots = np.append(stamps, stamps[-1] + widths[-1])
    edges = np.append(t, t[-1] + step)
    totals = np.stack([np.interp(edges, knots, column) for column in integral.T], axis=1)
    return np.diff(totals, axis=0) / np.diff(edges)[:, None]
