"""Readings that repeat because the log is written faster than its source refreshes them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modelgen.dataset.thresholds import USUAL, DatasetThresholds
from modelgen.numeric import Array

LEAST_UNEVEN = 4.0  # rows per refresh, below which changes anywhere are within a row of whole ones
REST = 5.0  # refreshes: a source that shows nothing new for longer rests, it has not missed so many
EXACT = 1e-13  # of the largest reading: a smaller change is the rounding of what a mapping computes
LIKE = 0.9  # of the changes of two columns that one clock refreshes, each of which may come again unchanged


@dataclass(frozen=True)
class Refresh:
    """every: rows from one new reading to the next. first: rows (M,) at which a new reading stands."""

    every: float
    first: np.ndarray

    def instants(self, t: Array) -> Array:
        """Times (M,) [s] of the readings, from the stamps (N,) of the rows.

        A refresh that is no whole number of rows shows first at rows that are a little late, now less, now
        more; the instants themselves are evenly spaced.
        """
        shown = t[self.first]
        even = np.polyval(np.polyfit(np.arange(len(shown)), shown - shown[0], 1), np.arange(len(shown)))
        late = shown - shown[0] - even
        row = float(np.median(np.diff(t)))
        return np.asarray(shown[0] + even) if 0.05 * row < np.ptp(late) < 1.5 * row else shown

    @property
    def times(self) -> str:
        """How often a reading stands there, in words."""
        waits = np.diff(self.first)
        low, high = waits.min(), int(np.quantile(waits, 0.99))
        varied = f" on average, from {low} to {high}" if high - low > max(1.01, 0.1 * self.every) else ""
        return f"{self.every:.4g} times{varied}"


def refresh_of(
    columns: Array, limits: DatasetThresholds = USUAL, *, even_only: bool = False
) -> Refresh | None:
    """The rows of columns (N, k) at which new readings stand; None where readings do not repeat.

    They do where all columns change together, at instants of their source. A column that moves by far more
    than its resolution and stands before it shows them, whatever the clock. A coarse encoder that turns
    slowly is distinguished from that: it changes by one step of its resolution. Coarse readings often come
    again at a refresh; what shows it then is that all changes lie a whole number of refreshes apart.
    even_only: of a source with an even clock, where the rows themselves have none.
    """
    changes = _steps(columns) != 0.0
    rows = np.flatnonzero(changes.any(axis=1)) + 1
    if len(rows) < limits.min_refreshes:
        return None
    if len(rows) * limits.min_repeats > len(columns):
        return None if even_only else _at_own_instants(columns, rows, limits)
    waits = np.diff(rows)
    common = _common(rows)
    if common >= limits.min_repeats and sum(_uneven(x, limits) for x in columns.T) > 1:
        return _refreshed(rows, common)
    every = float(np.median(waits))
    near = np.abs(waits - every) <= max(1.01, 0.1 * every)
    # A refresh may bring the same reading again: its change then comes after several.
    several = np.abs(waits / every - np.rint(waits / every)) * every <= max(1.01, 0.1 * every)
    regular = (
        every >= limits.min_repeats
        and near.mean() >= limits.single_refreshes
        and several.mean() > limits.whole_refreshes
        and not (waits < 0.5 * every).any()
    )
    if regular and any(_moves(column[rows], limits) for column in columns.T):
        return _refreshed(rows, float(np.mean(waits[near])))
    return None if even_only else _at_own_instants(columns, rows, limits)


def _at_own_instants(columns: Array, rows: np.ndarray, limits: DatasetThresholds) -> Refresh | None:
    """The refresh of a source whose clock need not be even; None where no column shows one.

    A column shows that all are refreshed at the rows (M,) of their changes where it stands, and then moves by
    far more than its resolution. What is read in every row moves in the row before.
    """
    if not any(_stands_and_moves(column, len(rows), limits) for column in columns.T):
        return None
    waits = np.diff(rows)
    short = waits[waits <= REST * np.mean(waits)]
    every = float(np.mean(short))
    if every < limits.least_repeats:
        return None
    first = [rows[:1]]
    for begin, wait in zip(rows[:-1], waits, strict=True):
        count = max(round(wait / every), 1) if wait > REST * every else 1
        first.append(begin + np.rint(wait * np.arange(1, count + 1) / count).astype(int))
    return Refresh(every, np.concatenate(first))


def _stands_and_moves(column: Array, changes: int, limits: DatasetThresholds) -> bool:
    """Whether a column (N,) changes at most of so many changes, by far more than its resolution, mostly after
    it stood, and comes to ever new readings: what has a few levels may stand at each of them.
    """
    steps = np.abs(_steps(column))
    rows = np.flatnonzero(steps)
    if len(rows) < LIKE * changes or len(np.unique(column[rows + 1])) < limits.min_refreshes:
        return False
    if not _moves(column[rows + 1], limits):
        return False
    size = steps[rows] / steps[rows].min()
    large = size > limits.refresh_over_resolution
    # The finer its steps, the more seldom what is read in every row is the same twice by chance.
    by_chance = limits.moves_after_standing * limits.refresh_over_resolution / float(np.median(size))
    stood = (np.diff(rows) > 1)[large[1:] & large[:-1]]
    return len(stood) > 0 and float(np.mean(stood)) > max(by_chance, 0.5 * (limits.least_repeats - 1.0))


def _common(rows: np.ndarray) -> float:
    """The distance that all distances of rows (M,) are multiples of, to a row where it is no whole number; 0
    where there is none above 1.
    """
    waits = np.diff(rows)
    whole = int(np.gcd.reduce(waits))
    every = float(np.mean(waits[waits <= 1.5 * waits.min()]))
    if whole > 1 or every < LEAST_UNEVEN:
        return float(whole) if whole > 1 else 0.0
    for _ in range(2):
        count = np.append(0, np.cumsum(np.rint(waits / every)))
        every, first = np.polyfit(count, rows, 1)
    apart = rows - first - every * count
    return float(every) if np.ptp(apart) < 1.5 else 0.0


def _refreshed(rows: np.ndarray, every: float) -> Refresh:
    """The rows of new readings, of which those (M,) that show a change are known."""
    waits = np.diff(rows)
    counts = np.maximum(np.rint(waits / every), 1).astype(int)
    inner = [rows[:1]]
    for begin, wait, count in zip(rows[:-1], waits, counts, strict=True):
        inner.append(begin + np.rint(wait * np.arange(1, count + 1) / count).astype(int))
    first = np.concatenate(inner)
    # What stood in the log's first rows began before it: when, nobody knows, but for a whole refresh.
    if abs(first[0] - every) <= max(1.01, 0.1 * every):
        first = np.concatenate([[0], first])
    return Refresh(every, first)


def _uneven(column: Array, limits: DatasetThresholds) -> bool:
    """Whether a column (N,) changes as no slow encoder at a constant speed does: by other than single steps,
    or after unlike times.
    """
    steps = _steps(column)
    rows = np.flatnonzero(steps)
    if len(rows) < limits.min_refreshes // 2:
        return False
    size, waits = np.abs(steps[rows]), np.diff(rows)
    usual = np.unique(waits, return_counts=True)[1].max() / len(waits)
    return bool(np.mean(size > 1.5 * size.min()) > 1.0 - limits.single_refreshes) or bool(
        usual < limits.single_refreshes
    )


def without_doubled(table: Array) -> tuple[Array, list[str]]:
    """A table (N, k), the time first, without rows that stand there twice with one stamp; remarks.

    Where rows of one stamp differ, the stamps are coarse, and none is left out.
    """
    again = np.append(False, np.diff(table[:, 0]) == 0.0)
    same = np.append(False, (np.diff(table, axis=0) == 0.0).all(axis=1))
    if not again.any() or not np.array_equal(again, same):
        return table, []
    return table[~same], [f"{int(same.sum())} rows stand there again, stamp and readings: each counts once"]


def _steps(columns: Array) -> Array:
    """Changes of columns (N, k), or of one (N,), from each row to the next."""
    steps = np.diff(columns, axis=0)
    return np.where(np.abs(steps) > EXACT * np.abs(columns).max(axis=0, initial=0.0), steps, 0.0)


def _moves(readings: Array, limits: DatasetThresholds) -> bool:
    """Whether readings (M,) move by more than steps of their own resolution."""
    steps = np.abs(_steps(readings))
    steps = steps[steps > 0.0]
    enough = len(steps) >= limits.min_refreshes // 2
    return enough and float(np.median(steps)) > limits.refresh_over_resolution * float(steps.min())
