"""Positions that are refreshed less often than the efforts beside them, row for row."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from modelgen.dataset.reading.repeats import Refresh, refresh_of
from modelgen.dataset.thresholds import USUAL, DatasetThresholds
from modelgen.numeric import Array


@dataclass(frozen=True)
class SlowPositions:
    """table: (M, k), a row for every new reading of the slowest position. every: rows of the log between
    them. hold: when its efforts act. names: positions that stand there several times.
    """

    table: Array
    every: float
    hold: str | float
    names: tuple[str, ...]


def slow_positions(
    names: Sequence[str],
    table: Array,
    positions: Sequence[int],
    efforts: Sequence[int],
    hold: str | float,
    limits: DatasetThresholds = USUAL,
) -> SlowPositions | None:
    """Rows at which the slowest position of a table (N, k) is new; None where none stands there repeatedly.

    A position that is new at other rows is interpolated by a cubic spline through its own readings. Efforts
    that are held count with their mean over the time up to the next row, others as they are in the row.
    names: of the columns, the time first. positions, efforts: their numbers. hold: as in `Source`.
    """
    found = refreshes(table, positions, limits)
    if not found:
        return None
    slowest = max(found, key=lambda k: found[k].every)
    rows, every = found[slowest].first, found[slowest].every
    result = table[rows].copy()
    result[:, 0] = found[slowest].instants(table[:, 0])
    for k, own in found.items():
        if not np.array_equal(own.first, rows):
            through = CubicSpline(own.instants(table[:, 0]), table[own.first, k])
            result[:, k] = through(result[:, 0])
    if hold in ("following", "previous"):
        ends = np.append(rows[1:], len(table))
        late = int(hold == "previous")
        for k in efforts:
            sums = np.append(0.0, np.cumsum(table[:, k]))
            low, high = np.minimum(rows + late, len(table) - 1), np.minimum(ends + late, len(table))
            result[:, k] = (sums[high] - sums[low]) / np.maximum(high - low, 1)
        hold = "following"
    inside = [np.full(len(rows), fill_value=True)]
    inside += [(rows >= own.first[0]) & (rows <= own.first[-1]) for own in found.values()]
    kept = np.logical_and.reduce(inside)
    return SlowPositions(result[kept], every, hold, tuple(names[k] for k in sorted(found)))


def refreshes(
    table: Array, positions: Sequence[int], limits: DatasetThresholds = USUAL
) -> dict[int, Refresh]:
    """The rows at which positions of a table (N, k) are new, by column; of those that repeat."""
    alone = {k: refresh_of(table[:, [k]], limits) for k in positions}
    found = {k: refresh for k, refresh in alone.items() if refresh is not None}
    if found or len(positions) < 2:
        return found
    together = refresh_of(table[:, list(positions)], limits)
    return {} if together is None else dict.fromkeys(positions, together)
