"""Functions of no law over what a force at a joint may depend on: its motion, another's, its past, the time.

A cause outside the catalogue that depends on more than the joint's own position and speed looks like a law of
these as long as it is held against functions of these alone. What a joint did before is remembered in two
ways: over time, as springs and dashpots in line do (Prony's series; Christensen 1982), and over the way,
whatever the pace, as springs that slip do (Brokate and Sprekels 1996).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from scipy.signal import lfilter

from modelgen.diagnosis.adequacy.smooth_functions import SmoothFunction, functions
from modelgen.diagnosis.equations import Equations
from modelgen.numeric import Array

OF_STATE = "the joint's position and speed"
OF_GAIN = "the joint's effort times a function of its position"
MEMORIES = np.geomspace(0.03, 3.0, 7)  # s, over which a force fades that the speed builds up
WAYS = np.geomspace(1e-3, 1.0, 8)  # of the range, over which a hysteresis builds up
EVEN = 1.0  # of the range, over which a hysteresis differs from place to place


def of_state(j: int, equations: Equations, series: bool = False) -> Iterator[SmoothFunction]:
    """Functions of position and speed of joint j (from 0), of every bend length, with a jump where the speed
    changes its sign and without.

    series: of the position, times the direction.
    """
    positions = [r.prepared.q[:, [j]] for r in equations.rows]
    over = positions if series else [np.hstack(x) for x in zip(positions, _speeds(j, equations), strict=True)]
    for bend in equations.thresholds.adequacy.bend_lengths:
        yield _function(OF_STATE, j, equations, over, bend, even=not series)
        if not series:
            yield _function(OF_STATE, j, equations, over, bend, jump=False)


def of_others(j: int, equations: Equations) -> Iterator[SmoothFunction]:
    """Functions of joint j (from 0) and another one: of their positions, of the position of j and the other's
    speed, of their speeds. The first with a jump where the speed of j changes its sign.
    """
    q, v = [r.prepared.q for r in equations.rows], [r.prepared.dq for r in equations.rows]
    bend, names = equations.thresholds.adequacy.bend_lengths[-1], equations.arm.coordinate_names
    for i in range(equations.n):
        if i == j:
            continue
        both = [x[:, [j, i]] for x in q]
        yield _function(f"the joint's position and that of {names[i]}", j, equations, both, bend)
        mixed = [np.column_stack([x[:, j], y[:, i]]) for x, y in zip(q, v, strict=True)]
        yield _function(
            f"the joint's position and the speed of {names[i]}", j, equations, mixed, bend, jump=False
        )
        both = [x[:, [j, i]] for x in v]
        yield _function(f"the joint's speed and that of {names[i]}", j, equations, both, bend, jump=False)


def of_gain(j: int, equations: Equations, inputs: Sequence[Array]) -> Iterator[SmoothFunction]:
    """At joint j (from 0) a gain of its drive that changes with its position.

    inputs: (N, n) of every record, as the model has them.
    """
    places = [r.prepared.q[:, [j]] for r in equations.rows]
    for bend in equations.thresholds.adequacy.bend_lengths:
        over = zip(equations.rows, functions(places, bend), inputs, strict=True)
        yield SmoothFunction(OF_GAIN, {j: [r.equation(j, x * u[:, [j]]) for r, x, u in over]})


def of_late(j: int, equations: Equations) -> SmoothFunction:
    """Of joint j (from 0) any sum of springs and dashpots in line, linear as these are.

    A log whose efforts pass a filter has it as well.
    """
    tables = [
        r.equation(j, np.hstack([_of_late(x, r.prepared.time, seconds) for seconds in MEMORIES]))
        for r, x in zip(equations.rows, _speeds(j, equations), strict=True)
    ]
    return SmoothFunction("the joint's mean speed over the last seconds", {j: tables})


def of_way(j: int, equations: Equations) -> SmoothFunction:
    """Of joint j (from 0) any hysteresis over its position, of which the size is a function of the place."""
    q = [r.prepared.q[:, [j]] for r in equations.rows]
    widths = WAYS * float(np.ptp(np.concatenate(q)))
    columns = [
        r.equation(j, np.hstack([x * place for x in hysteresis(path[:, 0], widths)]))
        for r, path, place in zip(equations.rows, q, _places(q), strict=True)
    ]
    return SmoothFunction("the joint's position and the way that it came", {j: columns})


def of_when(j: int, equations: Equations, inputs: Sequence[Array]) -> Iterator[SmoothFunction]:
    """At joint j (from 0) a force, and a gain of its drive, that change with the time since a record's begin.

    inputs: (N, n) of every record, as the model has them.
    """
    times = [(r.prepared.time - r.prepared.time[0])[:, None] for r in equations.rows]
    for bend in equations.thresholds.adequacy.bend_lengths:
        over = functions(times, bend)
        force = [r.equation(j, x) for r, x in zip(equations.rows, over, strict=True)]
        yield SmoothFunction("the time", {j: force})
        gain = [r.equation(j, x * u[:, [j]]) for r, x, u in zip(equations.rows, over, inputs, strict=True)]
        yield SmoothFunction("the joint's effort and the time", {j: gain})


def _places(positions: Sequence[Array]) -> list[Array]:
    """One, and even functions of the position: (N, k) of every record."""
    over = functions(positions, EVEN)
    return [np.hstack([np.ones((len(x), 1)), x]) for x in over]


def _speeds(j: int, equations: Equations) -> list[Array]:
    return [r.prepared.dq[:, [j]] for r in equations.rows]


def _function(
    text: str,
    j: int,
    equations: Equations,
    over: Sequence[Array],
    bend: float,
    *,
    jump: bool = True,
    even: bool = True,
) -> SmoothFunction:
    """Function at joint j of values (N, d) of every record; jump: times the direction of j as well; even: and
    without it.
    """
    tables = []
    for r, x, speed in zip(equations.rows, functions(over, bend), _speeds(j, equations), strict=True):
        parts = [x] * even + [x * np.sign(speed)] * jump
        tables.append(r.equation(j, np.hstack(parts)))
    return SmoothFunction(text, {j: tables})


def _of_late(speed: Array, time: Array, seconds: float) -> Array:
    """Mean of speeds (N, 1) at times (N,) that fades over so many seconds."""
    step = float(np.median(np.diff(time)))
    kept = float(np.exp(-step / seconds))
    return np.asarray(lfilter([1.0 - kept], [1.0, -kept], speed, axis=0))


def hysteresis(position: Array, widths: Array) -> Iterator[Array]:
    """Forces (N, 1) between -1 and 1 of springs of which each slips from a stretch of its width on, over
    positions (N,): between two turns of the motion what was there when it turned decides.
    """
    way = np.diff(position)
    turns = np.flatnonzero(way[1:] * way[:-1] < 0.0) + 1
    begins = np.concatenate([[0], turns])
    ends = np.concatenate([turns, [len(position) - 1]])
    for width in widths:
        found, stretch = np.zeros((len(position), 1)), 0.0
        for begin, end in zip(begins, ends, strict=True):
            part = np.clip(stretch + position[begin : end + 1] - position[begin], -width, width)
            found[begin : end + 1, 0] = part
            stretch = float(part[-1])
        yield found / width
