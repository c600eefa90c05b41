"""Bodies that turn against the links which carry them: their rates in the graph."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from modelgen.effects import BodyVariables
from modelgen.geometry import Frames
from modelgen.graph import Expr
from modelgen.graph.vectors import Vector, add, cross
from modelgen.model.motion import LinkMotion, Own, Rates, base_motion, moved
from modelgen.model.ports import Port
from modelgen.model.screws import PartialVelocities, Screw


@dataclass(frozen=True)
class Swinging:
    """`Swing` in the graph; joint: index into `arm.joints`; lift: of the pivot along z [m]."""

    joint: int
    cosine: Expr
    sine: Expr
    turn: Expr
    bend: Expr
    pivot: tuple[Expr, Expr]
    lift: Expr


def body_port(
    frames: Frames, body: Swinging, rates: Rates, motions: Sequence[LinkMotion], x: BodyVariables
) -> Port:
    """Velocities of the pivot, and against it of what lies 1 m away on either axis, in the body's axes."""
    frame = frames[body.joint]
    n, graph = frame.coordinate, frames.graph
    assert n is not None
    pivot = add(frame.origin, frame.to_antecedent_fixed((*body.pivot, body.lift)))
    own_frame = replace(frame, theta=(body.sine, body.cosine), origin=pivot)
    parent = base_motion(frames) if frame.antecedent is None else motions[frame.antecedent]
    dq, other = rates.dq[n], None if rates.reference is None else rates.reference[n]
    own = Own(
        body.turn * dq,
        body.turn * rates.ddq[n] + body.bend * (dq * (dq if other is None else other)),
        None if other is None else body.turn * other,
    )
    motion = moved(own_frame, parent, own)
    bound: dict[sp.Symbol, Expr] = {}
    columns = list(zip(*motion.field, strict=True))
    for symbols, vector in (
        (x.pivot, motion.acceleration),
        (x.along, columns[0]),
        (x.across, columns[1]),
        (x.gravity, motion.gravity),
    ):
        bound |= dict(zip(symbols, vector, strict=True))
    zero, one = graph.zero, graph.one
    screws: dict[int, Screw] = {}
    if frame.antecedent is not None:
        for m, (e, v) in PartialVelocities(frames).of_link[frame.antecedent].items():
            screws[m] = own_frame.to_link(e), own_frame.to_link(add(v, cross(e, pivot)))
    screws[n] = (zero, zero, body.turn), (zero, zero, zero)
    axes: tuple[Vector, Vector] = (one, zero, zero), (zero, one, zero)
    speeds = {m: (*v, *cross(e, axes[0]), *cross(e, axes[1])) for m, (e, v) in screws.items()}
    rows = tuple({m: s[k] for m, s in speeds.items() if not s[k].is_zero} for k in range(9))
    return Port(rows, bound, (*x.pivot, *x.along, *x.across))
