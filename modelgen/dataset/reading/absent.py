"""Efforts that nobody read: a number that stands still while the channel beside it never does."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset.processing.rest import runs
from modelgen.dataset.reading.clocks import Channels
from modelgen.numeric import Array

FEWEST = 3  # equal readings in a row, of a channel that never repeats one else
CHANCE = 1e-3  # of a record, that as many are equal where some neighbours are
MOST = 0.5  # of the readings: an effort that stands more often is switched, not read
JUMP = 6.0  # times the usual step, by which it is away from the readings before or after
LOOKS = 8  # at how many are equal by chance, each without the runs of the look before
MOVES = 0.02  # of its RMS speed, at which a joint moves, so that its effort has no reason to stand
FROZEN = 10  # equal readings in a row, at least, of a channel with noise that does not jump when it goes on
OFTEN = 0.99  # of its runs of equal readings, of whose length it must be that many times
TIMES = 4.0


def absent(values: Array, position: Array) -> NDArray[np.bool_]:
    """Flags (N,) of an effort's readings that are none: the channel dropped out, froze, or has a dead band.

    They are equal, several in a row, as chance does not make them in this channel, while the joint moves, and
    the effort jumps there and back; or it goes on from its last reading for much longer than it ever stands.
    One that stands as it is commanded, or is cut off, has no noise elsewhere, or goes there in usual steps.
    position: (N,), of the joint.
    """
    found = np.zeros(len(values), dtype=bool)
    begins = np.flatnonzero(np.append(True, np.diff(values) != 0.0))
    ends = np.append(begins[1:], len(values))  # the first reading after each run of equal ones
    lengths, least = ends - begins, FEWEST
    for _ in range(LOOKS):
        short = lengths < least
        equal = float(np.sum(lengths[short] - 1)) / max(float(np.sum(lengths[short])), 1.0)
        wanted = FEWEST if equal == 0.0 else 1 + math.ceil(math.log(CHANCE / len(values)) / math.log(equal))
        if wanted <= least:
            break
        least = wanted
    speed = np.abs(np.gradient(position))
    moves = np.add.reduceat(speed, begins) > MOVES * float(np.sqrt(np.mean(speed**2))) * lengths
    steps = np.abs(np.diff(values))
    usual = float(np.median(steps[steps > 0.0])) if np.any(steps > 0.0) else 0.0
    long = np.flatnonzero((lengths >= least) & moves & (begins > 0) & (ends < len(values)))
    if not len(long) or lengths[long].sum() > MOST * len(values):
        return found
    at = values[begins[long]]
    into, out = (np.abs(x - at) > JUMP * usual for x in (values[begins[long] - 1], values[ends[long]]))
    # At an end of the range an effort is cut off. Noise never stands, but what is commanded, or simulated,
    # may: there a jump shows it.
    inside = (at > values.min()) & (at < values.max())
    noisy = np.median(np.abs(np.diff(values, 2))) > usual
    much = lengths[long] >= TIMES * float(np.quantile(lengths[moves], OFTEN))
    dropped = long[out & into]
    frozen = long[inside & much & (out | (noisy & (lengths[long] >= FROZEN)))]
    for k in np.union1d(dropped, frozen):
        found[begins[k] : ends[k]] = True
    for level, often in zip(*np.unique(values[begins[dropped]], return_counts=True), strict=True):
        if often > 1:  # what stands for no reading does so alone, too
            found |= values == level
    return found


def without_absent(
    file: str, table: Array, channels: Channels
) -> tuple[Array, dict[str, NDArray[np.bool_]], list[str]]:
    """A table (N, k), the time first, whose efforts are straight lines where nobody read them; flags (N,) of
    these by the names of their columns; and remarks.
    """
    result, remarks, flags = table, list[str](), dict[str, NDArray[np.bool_]]()
    for k, place in {effort: position for position, effort in channels.pairs}.items():
        found, name = absent(table[:, k], table[:, place]), channels.names[k]
        if not found.any() or found.all():
            continue
        result = result.copy() if result is table else result
        t, there = table[:, 0], ~found
        result[found, k] = np.interp(t[found], t[there], table[there, k])
        flags[name] = found
        remarks.append(_said(f"{file}: {name}", t, table[:, k], found))
    return result, flags, remarks


def _said(name: str, t: Array, values: Array, flags: NDArray[np.bool_]) -> str:
    begins, ends = runs(flags).T
    lengths = ends - begins
    longest = int(np.argmax(lengths))
    first = begins[longest]
    places = "there" if len(begins) == 1 else f"in {len(begins)} places, {flags.sum()} rows in all"
    return (
        f"{name} stands at {values[first]:.6g} for {lengths[longest]} rows from t = {t[first]:.9g} s on, as "
        f"its readings never do else: it was not read {places}, and nothing is made of it"
    )
