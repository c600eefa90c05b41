"""Rows of several sources in turn: each channel has its own instants, and is blank at the others'."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.dataset.objects import Wanted
from modelgen.dataset.reading.between import SLOWER, between, is_smooth
from modelgen.dataset.thresholds import USUAL
from modelgen.errors import InputError
from modelgen.numeric import Array

FEWEST = 10  # blank cells of a column, from which on they are no mistakes
SHARE = 0.2  # of its rows, that must be blank, too
BURSTS = 0.2  # of the mean time between readings, below which the usual one says that they come in bursts

Readings = tuple[Array, Array]  # a channel's own stamps (N,) [s] and what was read at them (N,)


def blank_in_many(blank: int, rows: int) -> bool:
    """Whether a column that is blank in some of its rows says that rows of several sources come in turn.

    blank: number of its blank cells. rows: number of the rows that were looked at.
    """
    return blank >= FEWEST and blank > SHARE * rows


def in_turn(file: str, wanted: Wanted, table: Array) -> tuple[Array, str]:
    """Columns (N, k), the time first, blank where NaN, at common instants, as `joined`; a remark."""
    t = table[:, 0]
    if np.isnan(t).any():
        raise InputError(
            f"{file}: the time column {wanted.names[0]} is blank in row {int(np.argmax(np.isnan(t))) + 1}"
        )
    filled = ~np.isnan(table)
    readings = [(t[there], x[there]) for there, x in zip(filled.T[1:], table.T[1:], strict=True)]
    result, remark = joined(file, wanted, readings, t[filled[:, min(1, len(wanted.names) - 1)]])
    if remark:
        return result, remark
    short = ", ".join(name for name, there in zip(wanted.names, filled.T, strict=True) if not there.all())
    return result, f"{len(t) - len(result)} rows are left out, for they are without {short}"


def joined(file: str, wanted: Wanted, readings: Sequence[Readings], instants: Array) -> tuple[Array, str]:
    """A table (M, 1 + k) of k channels at common instants, and what was interpolated, "" for nothing.

    The instants are those of the channel whose readings come most seldom among positions and efforts, for
    nothing is known of an effort between two readings where it jumps; of efforts rather than of positions
    that are read as often. The others are interpolated where they have begun and not ended: positions on a
    smooth curve by cubic splines, all else by straight lines. instants: (N,) those used where nobody says
    which columns are positions and efforts. Raises InputError where a channel is blank for longer than a gap
    may last.
    """
    names = wanted.names[1:]
    for name, (stamps, _) in zip(names, readings, strict=True):
        if len(stamps) < 2:
            raise InputError(f"{file}: the column {name} holds no readings")
        _check_gaps(file, name, stamps)
    smooth = [
        name in wanted.positions
        and name not in wanted.turning
        and bool(np.isfinite(x).all())
        and is_smooth(x)
        for name, (_, x) in zip(names, readings, strict=True)
    ]
    base = _base(wanted, readings, smooth)
    at = instants if base is None else readings[base][0]
    for stamps, _ in readings:
        at = at[(at >= stamps[0]) & (at <= stamps[-1])]
    result = np.empty((len(at), 1 + len(names)))
    result[:, 0] = at
    curves, lines = list[str](), list[str]()
    for k, (name, (stamps, x)) in enumerate(zip(names, readings, strict=True)):
        own = np.searchsorted(stamps, at)
        if np.array_equal(stamps[np.minimum(own, len(stamps) - 1)], at):
            result[:, 1 + k] = x[own]
            continue
        if name in wanted.turning:
            raise InputError(
                f"{file}: the column {name} begins anew after a turn (`wrap` in the mapping), and is read at "
                "other instants than the others: nothing can be interpolated; log it with them, or unwrapped"
            )
        result[:, 1 + k] = between(stamps, x, at, smooth=smooth[k])
        (curves if smooth[k] else lines).append(name)
    where = names[0 if base is None else base] if names else ""
    done = [
        f"{', '.join(x)} interpolated by {how}"
        for x, how in ((lines, "straight lines"), (curves, "splines"))
        if x
    ]
    return result, f"rows come in turn: {', '.join(done)} at the instants of {where}" if done else ""


def _base(wanted: Wanted, readings: Sequence[Readings], smooth: Sequence[bool]) -> int | None:
    """The channel whose instants are used; None where no column is known as a position or an effort."""
    names = wanted.names[1:]
    step = [float(stamps[-1] - stamps[0]) / (len(stamps) - 1) for stamps, _ in readings]
    places = [k for k, name in enumerate(names) if name in wanted.positions]
    if not places:
        return None
    efforts = [k for k, name in enumerate(names) if name in wanted.efforts]
    place = max(places, key=lambda k: step[k])
    effort = max(efforts, key=lambda k: step[k], default=place)
    if wanted.turning.intersection(names):
        return next(k for k in places if names[k] in wanted.turning)
    least = 1.0 / SLOWER if all(smooth[k] for k in places) else SLOWER
    return effort if step[effort] >= least * step[place] else place


def _check_gaps(file: str, name: str, stamps: Array) -> None:
    steps = np.diff(stamps)
    usual, longest = float(np.median(steps)), float(steps.max())
    if longest <= USUAL.max_gap_periods * usual:
        return
    if usual < BURSTS * np.mean(steps):
        raise InputError(
            f"{file}: the stamps of the column {name} come in bursts, most {usual:.3g} s apart, up to "
            f"{longest:.4g} s: expected each row at the time at which it was read, or all columns in every "
            "row"
        )
    at = stamps[int(np.argmax(steps))]
    raise InputError(
        f"{file}: the column {name} is blank for {longest:.4g} s after t = {at:.9g}, expected a reading "
        f"every {usual:.4g} s"
    )
