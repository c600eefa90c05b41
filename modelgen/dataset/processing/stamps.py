"""Stamps that say less than the order of the samples: coarse ones, bursts, jitter of the transport."""

from __future__ import annotations

import numpy as np

from modelgen.dataset.thresholds import DatasetThresholds
from modelgen.numeric import Array

EVEN = 1e-6  # of a period: what is left of stamps in decimal digits


def true_stamps(t: Array, positions: Array, limits: DatasetThresholds) -> tuple[Array, str | None]:
    """Stamps (N,) [s], or evenly spaced ones where the positions (N, n) say so; a remark on that.

    Samples at even times and stamped late, in bursts or coarsely, make a motion rough that is smooth over
    evenly spaced instants; stamps that are true make it smoother than those.
    """
    steps, count = np.diff(t), len(t)
    if count < limits.min_samples or not np.isfinite(t).all() or (steps < 0.0).any():
        return t, None
    number = np.arange(count, dtype=np.float64)
    number -= number.mean()
    period = float(number @ (t - t.mean()) / (number @ number))
    even = t.mean() + period * number
    apart = float(np.abs(t - even).max())
    doubled = float(np.mean(steps == 0.0))
    if period <= 0.0 or apart > limits.max_gap_periods * period or apart <= limits.max_jitter * period:
        return t, None
    if doubled:
        if doubled < limits.doubled_stamps:
            return t, None
        said = f"{100 * doubled:.0f} % of the stamps equal the one before"
    elif roughness(even, positions) < limits.even_roughness * roughness(t, positions):
        said = f"stamps vary by up to {apart / period:.2g} periods and the positions do not follow them"
    else:
        return t, None
    return even, f"{said}: samples count as evenly spaced, at {1 / period:.6g} Hz"


def strayed(jitter: float) -> str:
    """How far the time between samples strays from the period, in words. jitter: of the period."""
    if jitter < 1.0:
        much = f"{jitter:.2g} of the sampling period"
    elif f"{jitter:.2g}" == "1":
        much = "a sampling period"
    else:
        much = f"{jitter:.2g} sampling periods"
    return f"time between samples varies by up to {much}"


def roughness(t: Array, positions: Array) -> float:
    """Power by which positions (N, n) differ from the cubic through their four neighbours, in their own."""
    around = [t[:-4], t[1:-3], t[3:-1], t[4:]]
    values = [positions[:-4], positions[1:-3], positions[3:-1], positions[4:]]
    here = t[2:-2]
    guess = np.zeros_like(positions[2:-2])
    for k in range(4):
        weight = np.ones_like(here)
        for j in range(4):
            if j != k:
                weight *= (here - around[j]) / (around[k] - around[j])
        guess += weight[:, None] * values[k]
    error = ((positions[2:-2] - guess) ** 2).mean(axis=0)
    return float(np.sum(error / np.maximum(positions.var(axis=0), 1e-300)))
