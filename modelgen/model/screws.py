"""Partial velocities: what a unit speed of one joint does to a link."""

from __future__ import annotations

from collections.abc import Collection

from modelgen.geometry import Frames
from modelgen.graph import Expr
from modelgen.graph.vectors import Vector, add, cross

Screw = tuple[Vector, Vector]  # angular velocity, velocity of the frame's origin, both in that frame


def partial_velocities(frames: Frames, slid: Collection[int] = ()) -> list[dict[int, Screw]]:
    """For every link, by coordinate: angular velocity and velocity of its origin, in its frame.

    Only the coordinates that move the link are listed. For the links in `slid` the velocity is that
    of the foot of the common normal on the joint's axis, r below the origin.
    """
    graph = frames.graph
    zero: Vector = (graph.zero, graph.zero, graph.zero)
    z: Vector = (graph.zero, graph.zero, graph.one)
    origins: dict[int, dict[int, Screw]] = {}
    chosen: list[dict[int, Screw]] = [{} for _ in frames.frames]
    for i in frames.order:
        frame = frames[i]
        point = frame.foot if i in slid else frame.origin
        own: dict[int, Screw] = {}
        if frame.antecedent is not None:
            for n, (e, v) in origins[frame.antecedent].items():
                own[n] = frame.to_link(e), frame.to_link(add(v, cross(e, point)))
        if frame.coordinate is not None:
            own[frame.coordinate] = (zero, z) if frame.prismatic else (z, zero)
        chosen[i] = own
        origins[i] = own if i not in slid else {n: (e, _along(e, v, frame.r)) for n, (e, v) in own.items()}
    return chosen


def _along(e: Vector, v: Vector, r: Expr) -> Vector:
    """Velocity of the point r further along z."""
    return (v[0] + r * e[1], v[1] - r * e[0], v[2])
