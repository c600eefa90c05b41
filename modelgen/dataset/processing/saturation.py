"""Efforts that end at one reading: the sensor or the controller cuts them off there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from modelgen.numeric import Array

BESIDE = 5  # levels below the highest, to which it is compared
FEWEST = 20  # readings
CUT_OFF = 0.01  # of the readings that move, at their highest level, if they are cut off there
SWITCHED = 0.05  # of the readings at either end, where an effort is switched between two
OFTENER = 6.0  # times as many as at the levels beside


def cut_off(values: Array, positions: Array) -> tuple[float, float] | None:
    """Reading at which an effort (N,) seems to be cut off, and its share of the moving ones, or None.

    A signal passes its highest level, and stands there no more often than at those below. One that is
    switched between two levels, and one at rest, is no case of this.
    """
    return next(iter(ends_of(values, positions)), None)


def saturated(values: Array, positions: Array) -> NDArray[np.bool_]:
    """Samples (N,) of an effort at a reading at which it seems to be cut off, and those beside them."""
    return standing_at(values, [level for level, _ in ends_of(values, positions)])


def standing_at(values: Array, levels: Sequence[float]) -> NDArray[np.bool_]:
    """Samples (N,) of an effort at some readings, and those beside them."""
    found = np.zeros(len(values), dtype=bool)
    for level in levels:
        found |= values == level
    # an effort that is moved to the instants of the positions has a part of its neighbours
    beside = np.append(found[1:], False) | np.append(False, found[:-1])
    return np.asarray(found | beside, dtype=bool)


def ends_of(values: Array, positions: Array) -> list[tuple[float, float]]:
    """Readings at which an effort (N,) is cut off as they alone show it, with their shares."""
    speed = np.abs(np.gradient(positions))
    moving = values[speed > 0.01 * np.quantile(speed, 0.99)]
    levels, counts = np.unique(moving, return_counts=True)
    switched = min(counts[0], counts[-1]) > SWITCHED * len(moving) if len(levels) else True
    if len(levels) < 2 * BESIDE or (switched and counts[0] + counts[-1] > 0.9 * len(moving)):
        return []
    ends = [
        (counts[-1], counts[-1 - BESIDE : -1], levels[-1]),
        (counts[0], counts[1 : 1 + BESIDE], levels[0]),
    ]
    return [
        (float(level), float(count / len(moving)))
        for count, beside, level in ends
        if count >= max(FEWEST, CUT_OFF * len(moving)) and count > OFTENER * max(1.0, float(np.mean(beside)))
    ]
