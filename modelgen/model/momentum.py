"""Generalised momentum of the links, and what their kinetic energy changes by with the coordinates."""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.geometry import Frames
from modelgen.graph import Expr
from modelgen.graph.vectors import Vector, add, cross
from modelgen.model.dynamics import Parameters
from modelgen.model.motion import Rates, link_motions, origin_velocities
from modelgen.model.wrench import carried_wrench


def link_momenta(frames: Frames, rates: Rates, parameters: Parameters) -> tuple[list[Expr], list[Expr]]:
    """p (n) = M dq [kg m^2/s or kg m/s] and dT/dq (n) [N m or N], one pass from the tips to the base.

    With h and L the momenta of all that joint j carries, w and v those of frame j: p_j = z.L and
    dT/dq_j = L.(w x z) + h.(v x z) where it turns, z.h and h.(w x z) where it slides. dM/dt dq less the
    Coriolis and centrifugal efforts is dT/dq (De Luca and Mattone 2005): no derivative of M is needed.
    """
    graph = frames.graph
    spins = [motion.velocity for motion in link_motions(frames, rates)]
    speeds = origin_velocities(frames, rates, spins)
    momenta = []
    for i, p in enumerate(parameters):
        with frames.noted(i, "momentum"):
            momenta.append(_own(spins[i], speeds[i], p))
    values, slopes = [graph.zero] * len(frames.coordinates), [graph.zero] * len(frames.coordinates)
    for i in reversed(frames.order):
        frame, (h, turning) = frames[i], momenta[i]
        w, v = spins[i], speeds[i]
        if frame.coordinate is not None:
            across = h[0] * w[1] - h[1] * w[0]
            if frame.prismatic:
                values[frame.coordinate], slopes[frame.coordinate] = h[2], across
            else:
                values[frame.coordinate] = turning[2]
                slopes[frame.coordinate] = turning[0] * w[1] - turning[1] * w[0] + (h[0] * v[1] - h[1] * v[0])
        if frame.antecedent is not None:
            with frames.noted(i, "momentum of it and all beyond"):
                back, turned = carried_wrench(frame, h, turning)
                own = momenta[frame.antecedent]
                momenta[frame.antecedent] = add(own[0], back), add(own[1], turned)
    return values, slopes


def _own(w: Vector, v: Vector, p: Sequence[Expr]) -> tuple[Vector, Vector]:
    """Linear and angular momentum of one link about its frame's origin."""
    xx, xy, xz, yy, yz, zz, *rest = p[:10]
    s, m = (rest[0], rest[1], rest[2]), rest[3]
    inertia: Vector = (
        xx * w[0] + xy * w[1] + xz * w[2],
        xy * w[0] + yy * w[1] + yz * w[2],
        xz * w[0] + yz * w[1] + zz * w[2],
    )
    return add((m * v[0], m * v[1], m * v[2]), cross(w, s)), add(inertia, cross(s, v))
