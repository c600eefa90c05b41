"""Derivatives of the links' efforts by composite bodies, one pass from the tips to the base.

Every joint's two columns are forces of the links beyond it, carried towards the base; its two rows are linear
forms of the motion of those links, carried likewise (Echeandia and Wensing 2021; Singh, Russell and Wensing
2022). In each frame the velocities are those that an observer sees who moves along with its origin, so that
only angular ones are left: with w the angular velocity, U the field of accelerations, a that of the origin,

    z x w and U z, a x z     are how a turn of the joint changes velocities and accelerations beyond it,
    N = [w]x (J - tr J / 2)  is what the inertia J makes of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from modelgen.geometry import Frame, Frames
from modelgen.geometry.frames import Pair
from modelgen.graph import Expr
from modelgen.graph.vectors import Matrix, Vector, add, column, cross, dot, scaled, times, transposed
from modelgen.model.composite import Body, carried_body
from modelgen.model.dynamics import Parameters, wrenches
from modelgen.model.motion import LinkMotion, Rates, link_motions, of_links
from modelgen.model.wrench import Wrench

Rows = list[list[Expr]]


@dataclass(frozen=True)
class EffortDerivatives:
    """Derivatives of the efforts (n) of the links, n x n each: by q, dq, and ddq (the mass matrix)."""

    by_q: Rows
    by_dq: Rows
    by_ddq: Rows


@dataclass(frozen=True)
class _Composite:
    """All links from one on, in its frame: body, momentum [kg m/s] and N [kg m^2/s]."""

    body: Body
    momentum: Vector
    turning: Matrix


def effort_derivatives(frames: Frames, rates: Rates, parameters: Parameters) -> EffortDerivatives:
    """The derivatives at the motion `rates`, for ten parameters of every link: for no fluid."""
    graph = frames.graph
    n = len(frames.coordinates)
    by_q, by_dq, by_ddq = ([[graph.zero] * n for _ in range(n)] for _ in range(3))
    motions = link_motions(frames, rates)
    shifts = _shifts(frames, of_links(frames, rates), motions)
    acting = wrenches(frames, motions, parameters)
    composites = [_own(motion, tuple(p)) for motion, p in zip(motions, parameters, strict=True)]
    for i in reversed(frames.order):
        frame = frames[i]
        if frame.coordinate is not None:
            with frames.noted(i, "derivatives"):
                found = _of_joint(frames, i, motions, shifts, composites[i], acting)
            for j, (row_q, row_dq, row_ddq, column_q, column_dq) in found.items():
                k = frame.coordinate
                by_q[k][j], by_dq[k][j], by_ddq[k][j] = row_q, row_dq, row_ddq
                if j != k:
                    by_q[j][k], by_dq[j][k], by_ddq[j][k] = column_q, column_dq, row_ddq
        if frame.antecedent is not None:
            with frames.noted(i, "inertia, momentum beyond"):
                carried = _carried(frame, composites[i], shifts[i])
                composites[frame.antecedent] = _sum(composites[frame.antecedent], carried)
    return EffortDerivatives(by_q, by_dq, by_ddq)


def _shifts(frames: Frames, rates: Rates, motions: Sequence[LinkMotion]) -> list[Vector]:
    """Velocity of every frame's origin against that of its antecedent's, in the antecedent's axes [m/s]."""
    zero = frames.graph.zero
    found = []
    for frame in frames.frames:
        shift: Vector = (zero, zero, zero)
        if frame.antecedent is not None:
            shift = cross(motions[frame.antecedent].velocity, frame.origin)
        if frame.coordinate is not None and frame.prismatic:
            shift = add(shift, frame.to_antecedent_fixed((zero, zero, rates.dq[frame.coordinate])))
        found.append(shift)
    return found


def _own(motion: LinkMotion, body: Body) -> _Composite:
    """One link alone."""
    xx, xy, xz, yy, yz, zz, *h = body[:9]
    w = motion.velocity
    half = (xx + yy + zz) * 0.5
    columns = [cross(w, c) for c in ((xx - half, xy, xz), (xy, yy - half, yz), (xz, yz, zz - half))]
    return _Composite(body, cross(w, (h[0], h[1], h[2])), transposed((columns[0], columns[1], columns[2])))


def _of_joint(
    frames: Frames,
    i: int,
    motions: Sequence[LinkMotion],
    shifts: Sequence[Vector],
    beyond: _Composite,
    acting: Sequence[Wrench],
) -> dict[int, tuple[Expr, Expr, Expr, Expr, Expr]]:
    """By joint j, from i to the base: d effort_i by q_j, dq_j, ddq_j, and d effort_j by q_i, dq_i."""
    frame, zero = frames[i], frames.graph.zero
    xx, xy, xz, yy, yz, zz, hx, hy, hz, m = beyond.body
    h, inertia = (hx, hy, hz), ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
    p, turning = beyond.momentum, beyond.turning
    speed, along, across = _changes(motions[i])
    twice = scaled(2.0, speed)
    force, moment = acting[i]
    if frame.prismatic:
        force_q, moment_q = scaled(m, along), add(cross(h, along), (-force[1], force[0], zero))
        force_dq, moment_dq = scaled(m, twice), cross(h, twice)
        ready, form, linear = (p[1] * 2.0, p[0] * -2.0, zero), (hy, -hx, zero), (zero, zero, m)
    else:
        force_q = add(add(cross(twice, p), scaled(m, across)), cross(along, h))
        force_q = add(force_q, (-force[1], force[0], zero))
        moment_q = add(add(times(turning, twice), times(inertia, along)), cross(h, across))
        moment_q = add(moment_q, (-moment[1], moment[0], zero))
        force_dq = add((p[1] * -2.0, p[0] * 2.0, zero), cross(twice, h))
        moment_dq = add(scaled(2.0, column(turning, 2)), times(inertia, twice))
        ready, form, linear = scaled(2.0, turning[2]), (xz, yz, zz), (-hy, hx, zero)
    found = {}
    current: int | None = i
    while current is not None:
        frame = frames[current]
        if frame.coordinate is not None:
            speed, along, across = _changes(motions[current])
            if frame.prismatic:
                rows = dot(linear, along), dot(linear, speed) * 2.0, linear[2]
                columns = force_q[2], force_dq[2]
            else:
                by_q = dot(ready, speed) + dot(form, along) + dot(linear, across)
                rows = by_q, ready[2] + dot(form, speed) * 2.0, form[2]
                columns = moment_q[2], moment_dq[2]
            found[frame.coordinate] = (*rows, *columns)
        if frame.antecedent is None:
            break
        turn, origin = frame.to_antecedent, frame.origin
        force_q, force_dq, linear = turn(force_q), turn(force_dq), turn(linear)
        moment_q = add(turn(moment_q), cross(origin, force_q))
        moment_dq = add(turn(moment_dq), cross(origin, force_dq))
        form = add(turn(form), cross(origin, linear))
        ready = add(turn(ready), cross(scaled(2.0, shifts[current]), linear))
        current = frame.antecedent
    return found


def _changes(motion: LinkMotion) -> tuple[Vector, Vector, Vector]:
    """w x z, U z and a x z: a turn of the joint changes velocities and accelerations beyond it by them."""
    w, a, field = motion.velocity, motion.acceleration, motion.field
    zero = w[0].graph.zero
    return (w[1], -w[0], zero), column(field, 2), (a[1], -a[0], zero)


def _carried(frame: Frame, of: _Composite, shift: Vector) -> _Composite:
    """The links in the antecedent's frame."""
    body = carried_body(frame, of.body)
    origin, m = frame.origin, of.body[9]
    p = frame.to_antecedent(of.momentum)
    turned = of.turning
    for pair, axes in ((frame.theta, (0, 1, 2)), (frame.alpha, (1, 2, 0)), (frame.gamma, (0, 1, 2))):
        turned = _turned(turned, pair, axes)
    after = _moments(body)
    trace = dot(origin, p) + dot(after, shift)
    moved = []
    for r in range(3):
        row = [turned[r][c] - (p[r] * origin[c] + shift[r] * after[c]) for c in range(3)]
        row[r] = row[r] + trace
        moved.append((row[0], row[1], row[2]))
    return _Composite(body, add(p, scaled(m, shift)), (moved[0], moved[1], moved[2]))


def _moments(body: Body) -> Vector:
    return body[6], body[7], body[8]


def _turned(matrix: Matrix, pair: Pair, axes: tuple[int, int, int]) -> Matrix:
    """The matrix turned by an angle about the axis k of the cyclic `axes` (i, j, k), as composite has it."""
    s, c = pair
    if s.is_zero and c.value == 1.0:
        return matrix
    i, j, k = axes
    rows = [list(row) for row in matrix]
    a, b, above, below = matrix[i][i], matrix[j][j], matrix[i][j], matrix[j][i]
    if c.is_zero:
        rows[i][i], rows[j][j], rows[i][j], rows[j][i] = b, a, -below, -above
    else:
        t = c * (a - b) - s * (above + below)
        rows[i][i], rows[j][j] = b + c * t, a - c * t
        rows[i][j], rows[j][i] = s * t + above, s * t + below
    x, y = matrix[i][k], matrix[j][k]
    rows[i][k], rows[j][k] = c * x - s * y, s * x + c * y
    x, y = matrix[k][i], matrix[k][j]
    rows[k][i], rows[k][j] = c * x - s * y, s * x + c * y
    turned = [(row[0], row[1], row[2]) for row in rows]
    return turned[0], turned[1], turned[2]


def _sum(a: _Composite, b: _Composite) -> _Composite:
    body = tuple(x + y for x, y in zip(a.body, b.body, strict=True))
    turning = [add(x, y) for x, y in zip(a.turning, b.turning, strict=True)]
    return _Composite(body, add(a.momentum, b.momentum), (turning[0], turning[1], turning[2]))
