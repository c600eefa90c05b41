"""Single readings that no motion has: a flipped bit, a wrong digit, a message that was read halfway."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from modelgen.dataset.processing.rounding import resolution
from modelgen.dataset.thresholds import DatasetThresholds
from modelgen.numeric import Array

STEPS = 3.0  # of the resolution, that rounding alone may put a reading off
NAMED = 3  # readings that a remark names
ALONE = 0.1  # of what a reading at an end is off, that those beside it may be off the cubic through theirs


def without_lone(
    file: str,
    table: Array,
    positions: Mapping[int, str],
    efforts: Mapping[int, str],
    limits: DatasetThresholds,
) -> tuple[Array, list[str]]:
    """A table (N, k) whose lone readings stand on the cubic through the four beside them, and remarks.

    positions, efforts: names of these columns, by number. An effort may jump for a sample, by a small part of
    its range, and begin or end with a step, which no position does. Where readings are off often, that is
    their noise, and nothing is changed.
    """
    remarks, result = [], table
    for k, name in [*positions.items(), *efforts.items()]:
        column = table[:, k]
        places, by = lone(column, limits, ends=k in positions)
        if k in efforts and len(places):
            low, high = np.quantile(column, (0.01, 0.99))
            large = np.abs(by) > limits.lone_effort * (high - low)
            places, by = places[large], by[large]
        if not len(places):
            continue
        result = result.copy() if result is table else result
        result[places, k] -= by
        at = ", ".join(f"{column[i]:.9g} in sample {i + 1}" for i in places[:NAMED])
        more = f" and {len(places) - NAMED} more" if len(places) > NAMED else ""
        remarks.append(
            f"{file}: {name} has a reading that those beside it rule out: {at}{more}; it is read as they say"
        )
    return result, remarks


@np.errstate(over="ignore", invalid="ignore")  # a wrong digit makes any number
def lone(values: Array, limits: DatasetThresholds, *, ends: bool = False) -> tuple[np.ndarray, Array]:
    """Places of lone readings among `values` (N,), and how far each is off the cubic through four neighbours.

    One that begins a step, and one of several in a row, is none: those beside it do not agree. ends: whether
    the two readings at either end are asked too, where a step cannot be distinguished from a lone one.
    """
    nothing = np.empty(0, dtype=int), np.empty(0)
    if len(values) < limits.min_lone_samples:
        return nothing
    before, after, far = values[1:-3], values[3:-1], values[4:] - values[:-4]
    off = values[2:-2] + (values[:-4] + values[4:] - 4.0 * (before + after)) / 6.0
    size = np.abs(off)
    usual = float(np.quantile(size, 0.99))
    found = size > limits.lone_reading * usual
    if not found.any():
        return nothing
    step = resolution(np.delete(values, np.flatnonzero(found) + 2)) or 0.0
    found &= size > STEPS * step
    # a reading that is off takes its neighbours along, by two thirds and a sixth
    largest = size >= np.max(np.lib.stride_tricks.sliding_window_view(np.pad(size, 2), 5), axis=1)
    found &= largest & (np.abs(after - before - 0.5 * far) < 0.5 * size)
    places = np.flatnonzero(found)
    own, by = places + 2, off[places]
    if ends:
        least = max(limits.lone_reading * usual, STEPS * step)
        for place, apart in (*_at_begin(off, least), *((-1 - k, x) for k, x in _at_begin(off[::-1], least))):
            own, by = np.append(own, place % len(values)), np.append(by, apart)
    return own, by


def _at_begin(off: Array, least: float) -> list[tuple[int, float]]:
    """The first or the second reading where it is lone, and how far it is off the cubic through those beside.

    off: of the third reading and those after it. A lone one is in the fourth difference of five readings with
    the weights 1, -4, 6, -4 and 1, by its place among them.
    """
    first, second, third = 6.0 * off[:3]
    if not abs(first) > 6.0 * least:
        return []
    if abs(second) < ALONE * abs(first):
        return [(0, float(first))]
    if abs(second + first / 4.0) < ALONE * abs(first) and abs(third) < ALONE * abs(first):
        return [(1, float(-first / 4.0))]
    return []
