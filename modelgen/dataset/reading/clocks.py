"""Columns of a log, each refreshed at instants of its own: one row for every reading of the slowest."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from modelgen.dataset.reading.between import SLOWER, between, is_smooth
from modelgen.dataset.reading.repeats import Refresh, refresh_of
from modelgen.dataset.thresholds import USUAL, DatasetThresholds
from modelgen.numeric import Array

# Of the changes of a column, those that come when another is refreshed: the least for one clock, where both
# are as fast, and for a coarse column, which changes now and then.
_BOTH, _COARSE = 0.9, 0.98
# Rows of the efforts per reading of a position: a cut-off, at most a 25th of their rate, is then at most a
# fifth of the position's, up to which splines through its readings are right to a part in a thousand.
_PER_READING = 5
# Times the usual step between stamps, from which on a row came late, and how many such rows a log has that is
# written by a clock, lost ones and what a busy machine delays among them.
_LATE, _SELDOM = 2.5, 0.1
_FEW = 20  # changes of a coarse column, by which chance cannot put them all where another is refreshed


@dataclass(frozen=True)
class Fresh:
    """table: (M, k), at instants at which channels are new. every: rows per reading of the slowest of them.

    hold: when its efforts act. together: whether every position is new where its effort is. remarks: what
    stands there how often.
    """

    table: Array
    every: float
    hold: str | float
    together: bool
    remarks: tuple[str, ...]


@dataclass(frozen=True)
class Channels:
    """Columns of a table: their names, the time first; positions and efforts among them, by number; pairs of
    a position and the effort of its joint. hold, stated: as in `Source`.
    """

    names: Sequence[str]
    positions: Sequence[int]
    efforts: Sequence[int]
    pairs: Sequence[tuple[int, int]] = ()
    hold: str | float = "following"
    stated: bool = False


def clocks(
    table: Array, positions: Sequence[int], efforts: Sequence[int], limits: DatasetThresholds = USUAL
) -> dict[int, Refresh]:
    """When columns of a table (N, k), the time first, are refreshed, by number; of those that repeat.

    Columns that change at the same rows have one clock, the same object. A coarse column has that at whose
    refreshes alone it changes.
    """
    motion, every = (*positions, *efforts), range(1, table.shape[1])
    steps = np.diff(table[:, 0])
    # A motor that is logged whenever it has moved on stands, and then moves: that shows no clock of a source.
    unpaced = bool(np.mean(steps > _LATE * np.median(steps)) > _SELDOM)
    found: dict[int, Refresh] = {}
    for together in (tuple(every), motion):
        if (
            not found
            and (whole := refresh_of(table[:, list(together)], limits, even_only=unpaced)) is not None
        ):
            found = dict.fromkeys(together, whole)
    changes = {k: np.flatnonzero(np.diff(table[:, k])) + 1 for k in every}
    known = {id(x): (x, len(np.unique(np.concatenate([changes[k] for k in found])))) for x in found.values()}
    alone = {k: refresh_of(table[:, [k]], limits, even_only=unpaced) for k in motion}
    own = {k: x for k, x in alone.items() if x is not None}
    for k, refresh in sorted(own.items(), key=lambda item: item[1].every):
        for clock, often in known.values():
            as_fast = refresh.every < SLOWER * clock.every or len(changes[k]) * SLOWER > often
            if as_fast and _share(changes[k], clock) >= _BOTH:
                found[k] = clock
                break
        else:
            found[k], known[id(refresh)] = refresh, (refresh, len(changes[k]))
    slowest_first = sorted((x for x, _ in known.values()), key=lambda x: -x.every)
    for k in every:
        if k not in found and len(changes[k]) >= _FEW:
            shared = [x for x in slowest_first if _share(changes[k], x) >= _COARSE]
            found |= dict.fromkeys([k], shared[0]) if shared else {}
    if not any(k in found for k in positions) and len(positions) > 1:
        jointly = refresh_of(table[:, list(positions)], limits, even_only=unpaced)
        found |= {} if jointly is None else dict.fromkeys(positions, jointly)
    return found


def _share(changes: np.ndarray, clock: Refresh) -> float:
    """Share of the rows (M,) of changes at which a clock refreshes."""
    return float(np.isin(changes, clock.first).mean())


def fresh(table: Array, channels: Channels, limits: DatasetThresholds = USUAL) -> Fresh | None:
    """A table (N, k) at instants at which channels are new; None where no position or effort repeats.

    Each reading counts once, at the instant at which it is new. The rows are those of the slowest effort,
    where positions are smooth enough to be interpolated to them, else those of the slowest channel. What has
    another clock is interpolated between its own instants, positions by cubic splines, all else by straight
    lines. Efforts that act until the next row, all read in each, count with their mean up to the next.
    """
    found = clocks(table, channels.positions, channels.efforts, limits)
    of_motion = {k: found[k] for k in (*channels.positions, *channels.efforts) if k in found}
    if not of_motion:
        return None
    slowest, t = max(of_motion.values(), key=lambda x: x.every), table[:, 0]
    clock, rows = _rows(table, channels, of_motion, slowest)
    at = t[rows] if clock is None else clock.instants(t)[np.isin(clock.first, rows)]
    result = table[rows].copy()
    result[:, 0] = at
    inside = np.full(len(rows), fill_value=True)
    each_row = not any(k in found for k in channels.efforts)
    hold, averaged = channels.hold, list(channels.efforts) if each_row else []
    evened = not np.array_equal(at, t[rows])
    for k in range(1, table.shape[1]):
        own, smooth = found.get(k), k in channels.positions
        if own is not None and own is not clock:
            result[:, k] = between(own.instants(t), table[own.first, k], at, smooth=smooth)
            inside &= (rows >= own.first[0]) & (rows <= own.first[-1])
        elif own is None and evened and k not in averaged:
            result[:, k] = between(t, table[:, k], at, smooth=smooth)
    if averaged and hold in ("following", "previous"):
        _average(result, table, rows, averaged, late=int(hold == "previous"))
        hold = "following"
    elif not each_row and not channels.stated:
        hold = "instant"
    together = bool(channels.pairs) and all(
        k in found and found[k] is found.get(j) for k, j in channels.pairs
    )
    said = _said(channels, found, t)
    if hold != channels.hold and not each_row and not together:
        said = (*said, "an effort counts as read at the instant at which it is new (hold: instant)")
    return Fresh(result[inside], slowest.every, hold, together, said)


def _rows(
    table: Array, channels: Channels, found: Mapping[int, Refresh], slowest: Refresh
) -> tuple[Refresh | None, np.ndarray]:
    """The clock whose rows are used, None where every row may be; those of its rows that are."""
    slow = [k for k in channels.positions if found.get(k) is slowest]
    of_efforts = [found[k] for k in channels.efforts if k in found]
    clock = max(of_efforts, key=lambda x: x.every, default=None)
    if not slow or not channels.efforts or clock is slowest or not all(is_smooth(table[:, k]) for k in slow):
        return slowest, slowest.first
    rows = np.arange(len(table)) if clock is None else clock.first
    stride = int(slowest.every / (_PER_READING * (1.0 if clock is None else clock.every)))
    return clock, rows[:: max(stride, 1)]


def _average(result: Array, table: Array, rows: np.ndarray, efforts: Sequence[int], *, late: int) -> None:
    """Efforts become their mean from each of the rows to the next."""
    ends = np.append(rows[1:], len(table))
    for k in efforts:
        sums = np.append(0.0, np.cumsum(table[:, k]))
        low, high = np.minimum(rows + late, len(table) - 1), np.minimum(ends + late, len(table))
        result[:, k] = (sums[high] - sums[low]) / np.maximum(high - low, 1)


def repeated_in(table: Array, channels: Channels, limits: DatasetThresholds = USUAL) -> tuple[str, ...]:
    """Remarks about columns of a table (N, k) that repeat, whose rows nobody has read yet."""
    found = clocks(table, channels.positions, channels.efforts, limits)
    if found and len({id(x) for x in found.values()}) == 1 and len(found) == len(channels.names) - 1:
        clock = next(iter(found.values()))
        return (f"every reading stands there {clock.times}: the source is slower than the log",)
    return tuple(f"{_stand(channels.names, found, x)} while others change" for x in _groups(found))


def _said(channels: Channels, found: Mapping[int, Refresh], t: Array) -> tuple[str, ...]:
    """Remarks about what repeats, and what is made of it."""
    rate = (len(t) - 1) / (t[-1] - t[0])
    names, groups = channels.names, _groups(found)
    clock = groups[-1]
    if len(groups) == 1 and len(found) == len(names) - 1:
        return (
            f"every reading stands there {clock.times}: the log has {rate:.6g} Hz, its source "
            f"{rate / clock.every:.6g} Hz; new readings alone are used, at their instants",
        )
    if len(groups) == 1 and set(found) <= set(channels.positions):
        return (
            f"{_stand(names, found, clock)} while others change: the log has {rate:.6g} Hz, its positions "
            f"{rate / clock.every:.6g} Hz; each counts once, at the instant at which it is new",
        )
    counts = "; ".join(f"{_stand(names, found, x)}, at {rate / x.every:.6g} Hz" for x in groups)
    return (
        f"{counts}; the log has {rate:.6g} Hz: channels are refreshed at instants of their own; each reading "
        "counts once, at the instant at which it is new; better log each once, or with its own stamp",
    )


def _groups(found: Mapping[int, Refresh]) -> list[Refresh]:
    """The clocks of columns, the fastest first."""
    return sorted({id(x): x for x in found.values()}.values(), key=lambda x: x.every)


def _listed(names: Sequence[str], found: Mapping[int, Refresh], clock: Refresh) -> str:
    return ", ".join(names[k] for k in sorted(found) if found[k] is clock)


def _stand(names: Sequence[str], found: Mapping[int, Refresh], clock: Refresh) -> str:
    which = _listed(names, found, clock)
    return f"{which} {'stand' if ', ' in which else 'stands'} there {clock.times}"
