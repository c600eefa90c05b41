"""Waves over the position of a drive: where a search for a force that repeats with it begins."""

from __future__ import annotations

from typing import Any

import numpy as np

from modelgen.diagnosis.options.thresholds import CandidateThresholds
from modelgen.numeric import Array


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
    grid = step * np.arange(3, min(4000, max(8, int(highest / step))))
    power = np.concatenate(
        [
            np.abs(np.exp(1j * np.outer(part, position)) @ residual) ** 2
            for part in np.array_split(grid, max(1, len(grid) // 200))
        ]
    )
    order: list[Any] = []
    for k in np.argsort(power)[::-1]:
        if all(abs(k - other) > 2 for other in order):
            order.append(k)
        if len(order) == limits.scanned_waves:
            break
    return [float(grid[k]) for k in order]
