"""What it takes to move one link: force and moment at the origin of its frame.

A link has ten standard parameters XX, XY, XZ, YY, YZ, ZZ (inertia tensor about the origin of frame
j), MX, MY, MZ (first moments) and M, and in a fluid four more, VX, VY, VZ, V (first moments of the
displaced volume, volume). The moments are written with the field U instead of J dw + w x J w,
which takes some forty multiplications less on a six-joint arm.
"""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.graph import Expr
from modelgen.graph.vectors import Matrix, Vector, add, column, cross, dot, times
from modelgen.model.motion import LinkMotion
from modelgen.model.screws import Screw

Wrench = tuple[Vector, Vector]  # force, moment


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


def projected_columns(motion: LinkMotion, screw: Screw, count: int, density: float, slide: Expr) -> list[Expr]:
    """The link's columns of the regressor, as seen by a joint.

    `screw`: angular velocity [1] and velocity [m or 1] per unit speed of the joint, in the link's
    frame; the velocity is that of the point `slide` [m] below the frame's origin on its z axis.
    Each column of the 6 x `count` map from parameters to wrench, moved to that point, is dotted with
    the screw: Kane's form (Kane and Levinson 1983). The point is free to choose; where joints meet
    in it their columns are short.
    """
    (x, y, z), v = screw
    u, a, axial = motion.field, motion.acceleration, motion.axial
    syz, sxz, sxy = motion.products[1]
    dx, dy, dz = motion.stretch
    columns = [
        x * axial[0] + (y * sxz - z * sxy),
        y * u[2][1] - x * u[2][0] + z * dz,
        x * u[1][0] - z * u[1][2] + y * dy,
        y * axial[1] + (z * sxy - x * syz),
        z * u[0][2] - y * u[0][1] + x * dx,
        z * axial[2] + (x * syz - y * sxz),
    ]
    moments = moments_of_first_moments(a)
    for i in range(3):
        columns.append(_projected((x, y, z), v, column(u, i), moments[i], slide))
    zero = slide * 0.0
    columns.append(_projected((x, y, z), v, a, (zero, zero, zero), slide))
    if count > 10:
        g = motion.gravity
        moments = moments_of_first_moments(g)
        still = (zero, zero, zero)
        columns += [_projected((x, y, z), v, still, m, slide) * density for m in moments]
        columns.append(_projected((x, y, z), v, g, still, slide) * density)
    return columns


def moments_of_first_moments(a: Vector) -> Matrix:
    """Unit vectors crossed with a: the moments of MX, MY and MZ where the origin accelerates by a."""
    zero = a[0] * 0.0
    return (zero, -a[2], a[1]), (a[2], zero, -a[0]), (-a[1], a[0], zero)


def _projected(e: Vector, v: Vector, force: Vector, moment: Vector, slide: Expr) -> Expr:
    turning = (moment[0] - slide * force[1], moment[1] + slide * force[0], moment[2])
    return dot(v, force) + dot(e, turning)
