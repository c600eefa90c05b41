"""Signals moved from their stamps to a uniform time axis."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator

from modelgen.numeric import Array

REACH = 64  # stamps: a cubic spline forgets a value at 0.27 per stamp


def smooth_resampled(stamps: Array, values: Array, t: Array, step: float, method: str) -> Array:
    """A continuous signal (N, k) at the times t (M,), `step` apart; method as in Axis.

    Cubic splines where the stamps are nearly even; monotone cubics (PCHIP), which do not ring, where they
    are not; means of the broken line around each time where the new axis is coarser.
    """
    if method == "mean":
        return _means(stamps, values, t, step)
    curve = CubicSpline(stamps, values) if method == "spline" else PchipInterpolator(stamps, values)
    return np.asarray(curve(t), dtype=np.float64)


def efforts_resampled(
    stamps: Array, efforts: Array, t: Array, step: float, method: str, hold: str | float
) -> tuple[Array, float]:
    """Efforts (N, k) read as `hold` says, on the axis t (M,), and how far their samples lie after it [s]."""
    if hold in ("following", "previous"):
        if hold == "previous":  # the same staircase, each value one sample earlier
            efforts = np.vstack([efforts[1:], efforts[-1:]])
        return held_resampled(stamps, efforts, t, step), 0.5 * step
    later = hold if isinstance(hold, float) else 0.0
    return smooth_resampled(stamps + later, efforts, t, step, method), 0.0


def held_resampled(stamps: Array, values: Array, t: Array, step: float) -> Array:
    """A signal (N, k) that is constant from each stamp to the next: its mean over each [t, t + step].

    The mean keeps the effort's integral, so that no delay and no bias come in.
    """
    widths = np.diff(stamps, append=max(stamps[-1], t[-1]) + step)
    integral = np.vstack([np.zeros((1, values.shape[1])), np.cumsum(values * widths[:, None], axis=0)])
    knots = np.append(stamps, stamps[-1] + widths[-1])
    return (_columns(t + step, knots, integral) - _columns(t, knots, integral)) / step


def _means(stamps: Array, values: Array, t: Array, step: float) -> Array:
    """Mean of the broken line through values (N, k) over each [t - step/2, t + step/2] within the stamps."""
    low = np.clip(t - 0.5 * step, stamps[0], stamps[-1])
    high = np.clip(t + 0.5 * step, stamps[0], stamps[-1])
    knots = np.unique(np.concatenate([stamps, low, high]))
    line = _columns(knots, stamps, values)
    pieces = 0.5 * (line[1:] + line[:-1]) * np.diff(knots)[:, None]
    area = np.vstack([np.zeros((1, values.shape[1])), np.cumsum(pieces, axis=0)])
    width = (high - low)[:, None]
    inside = width > 1e-9 * step  # beyond the stamps the last value stays
    mean = (_columns(high, knots, area) - _columns(low, knots, area)) / np.where(inside, width, 1.0)
    return np.where(inside, mean, _columns(low, stamps, values))


def _columns(x: Array, knots: Array, values: Array) -> Array:
    return np.stack([np.interp(x, knots, column) for column in values.T], axis=1)
