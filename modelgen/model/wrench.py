"""Wrench that moves one link: force and moment at the origin of its frame.

A link has ten standard parameters XX, XY, XZ, YY, YZ, ZZ (inertia tensor about the origin of frame
j), MX, MY, MZ (first moments) and M, and in a fluid four more, VX, VY, VZ, V (first moments of the
displaced volume, volume). The moments are written with the field U instead of J dw + w x J w,
which takes some forty multiplications less on a six-joint arm.
"""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.geometry import Frame
from modelgen.graph import Expr
from modelgen.graph.vectors import Vector, add, cross, times
from modelgen.model.motion import LinkMotion

Wrench = tuple[Vector, Vector]  # force, moment


def carried_wrench(frame: Frame, force: Vector, moment: Vector) -> Wrench:
    """A wrench, or another pair that changes its point like one, at the antecedent's origin in its axes."""
    back = frame.to_antecedent(force)
    return back, add(frame.to_antecedent(moment), cross(frame.origin, back))


def wrench(motion: LinkMotion, p: Sequence[Expr], density: float) -> Wrench:
    """Force [N] and moment [N m] for the parameters `p` (10, or 14 in a fluid of `density` kg/m^3)."""
    xx, xy, xz, yy, yz, zz, mx, my, mz, m = p[:10]
    u, a = motion.field, motion.acceleration
    force = add((m * a[0], m * a[1], m * a[2]), times(u, (mx, my, mz)))
    x, y, z = motion.axial
    syz, sxz, sxy = motion.products[1]
    dx, dy, dz = motion.stretch
    moment: Vector = (
        x * xx + syz * (zz - yy) - u[2][0] * xy + u[1][0] * xz + dx * yz,
        y * yy + sxz * (xx - zz) + u[2][1] * xy - u[0][1] * yz + dy * xz,
        z * zz + sxy * (yy - xx) + u[0][2] * yz - u[1][2] * xz + dz * xy,
    )
    moment = add(moment, cross((mx, my, mz), a))
    if len(p) > 10:
        g = motion.gravity
        vx, vy, vz, v = (e * density for e in p[10:])
        force = add(force, (v * g[0], v * g[1], v * g[2]))
        moment = add(moment, cross((vx, vy, vz), g))
    return force, moment
