"""Kinetic and potential energy of the links."""

from __future__ import annotations

from modelgen.geometry import Frames
from modelgen.graph import Expr
from modelgen.graph.vectors import Vector, cross, dot
from modelgen.model.dynamics import Parameters
from modelgen.model.motion import Rates, link_motions, origin_velocities


def link_energies(frames: Frames, rates: Rates, parameters: Parameters) -> tuple[Expr, Expr]:
    """Kinetic and potential energy [J] of the links; potential zero at the base's origin.

    Linear in the parameters: T = w'Jw / 2 + s'(v x w) + M v'v / 2, U = -g'(s + M p), and in a fluid
    + density g'(V p + first moments of the volume).
    """
    graph, density = frames.graph, frames.arm.fluid_density
    motions = link_motions(frames, rates)
    velocities = origin_velocities(frames, rates, [motion.velocity for motion in motions])
    height: dict[int | None, Expr] = {None: graph.zero}  # g . p
    x, y, z = (frames.scalars(component) for component in frames.arm.gravity)
    gravity: dict[int | None, Vector] = {None: (x, y, z)}
    kinetic, potential = graph.zero, graph.zero
    for i in frames.order:
        frame, motion = frames[i], motions[i]
        before = frame.antecedent
        v = velocities[i]
        height[i] = height[before] + dot(gravity[before], frame.origin)
        gravity[i] = motion.gravity
        xx, xy, xz, yy, yz, zz, mx, my, mz, m = parameters[i][:10]
        w = motion.velocity
        momentum = (
            xx * w[0] + xy * w[1] + xz * w[2],
            xy * w[0] + yy * w[1] + yz * w[2],
            xz * w[0] + yz * w[1] + zz * w[2],
        )
        kinetic = kinetic + (dot(momentum, w) + m * dot(v, v)) * 0.5 + dot((mx, my, mz), cross(v, w))
        potential = potential - (dot((mx, my, mz), motion.gravity) + m * height[i])
        if len(parameters[i]) > 10:
            vx, vy, vz, volume = parameters[i][10:]
            potential = potential + (dot((vx, vy, vz), motion.gravity) + volume * height[i]) * density
    return kinetic, potential
