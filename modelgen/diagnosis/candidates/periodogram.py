"""Waves over the position of a drive: where a search for a force that repeats with it begins."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from modelgen.diagnosis.options.thresholds import CandidateThresholds
from modelgen.numeric import Array

# Budgets of the search: how many points of the grid, for each wave that is begun at, are looked about, and at
# how many places from the point before to the point after.
MANY = 8
PLACES = 17


def waves(
    residual: Array, position: Array, speed: Array, cutoff: float, limits: CandidateThresholds
) -> list[float]:
    """Wave numbers [rad per motor unit] at which a residual repeats with the motor's position, best first.

    residual, position, speed: (M,). A periodogram over position (Lomb 1976), of waves that pass slower
    than the cut-off [Hz] for `slow_rows_share` of the rows at least.
    """
    if len(residual) < limits.min_wave_rows or np.ptp(position) <= 0:
        return []
    span = float(np.ptp(position))
    slow = float(np.quantile(np.abs(speed), limits.slow_rows_share))
    step = np.pi / span
    highest = 2 * np.pi * cutoff / max(slow, 1e-9 * span)
    grid = np.asarray(step * np.arange(3, min(4000, max(8, int(highest / step)))), dtype=np.float64)
    peaks = _between(grid, step, partial(_power, residual, position), MANY * limits.scanned_waves)
    order: list[float] = []
    for wave in peaks:
        if all(abs(wave - other) > step for other in order):
            order.append(wave)
        if len(order) == limits.scanned_waves:
            break
    return order


def _between(grid: Array, step: float, power: Callable[[Array], Array], count: int) -> list[float]:
    """Peaks of the power between the points of a grid, best first, by its `count` best points.

    Records of other places let a peak fall into fringes that are narrower than the grid.
    """
    best = grid[np.argsort(power(grid))[::-1][:count]]
    near = best[:, None] + step * np.linspace(-1.0, 1.0, PLACES)
    values = power(near.ravel()).reshape(near.shape)
    inside = [(values[k, i], near[k, i]) for k, i in enumerate(values.argmax(axis=1)) if 0 < i < PLACES - 1]
    return [float(wave) for _, wave in sorted(inside, reverse=True)]


def _power(residual: Array, position: Array, waves: Array) -> Array:
    """Power (W,) of waves [rad per motor unit]."""
    return np.concatenate(
        [
            np.abs(np.exp(1j * np.outer(part, position)) @ residual) ** 2
            for part in np.array_split(waves, max(1, len(waves) // 200))
        ]
    )
