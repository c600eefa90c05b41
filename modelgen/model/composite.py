"""Mass matrix by composite rigid bodies (Walker and Orin 1982)."""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.geometry import Frame, Frames
from modelgen.graph import Expr
from modelgen.graph.vectors import Vector
from modelgen.model.dynamics import Parameters
from modelgen.model.wrench import carried_wrench

# Share of a diagonal element that a pivot must exceed.
VANISHED = 1e-9

Body = tuple[Expr, ...]  # XX, XY, XZ, YY, YZ, ZZ, MX, MY, MZ, M


def mass_matrix(frames: Frames, parameters: Parameters) -> list[list[Expr]]:
    """Joint-space mass matrix of the links, n x n [kg m^2, kg m, kg]; drives apart."""
    graph = frames.graph
    n = len(frames.coordinates)
    matrix = [[graph.zero] * n for _ in range(n)]
    bodies: list[Body] = [tuple(p[:10]) for p in parameters]
    for i in reversed(frames.order):
        frame = frames[i]
        if frame.coordinate is not None:
            with frames.noted(i, "column of the mass matrix"):
                _fill(frames, i, bodies[i], matrix)
        if frame.antecedent is not None:
            with frames.noted(i, "inertia of it and all beyond"):
                carried = carried_body(frame, bodies[i])
                total = zip(bodies[frame.antecedent], carried, strict=True)
                bodies[frame.antecedent] = tuple(a + b for a, b in total)
    return matrix


def _fill(frames: Frames, i: int, body: Body, matrix: list[list[Expr]]) -> None:
    """Efforts of all joints before link i for a unit acceleration of joint i."""
    frame, zero = frames[i], frames.graph.zero
    _, _, xz, _, yz, zz, mx, my, _, m = body
    force: Vector
    moment: Vector
    if frame.prismatic:
        force, moment = (zero, zero, m), (my, -mx, zero)
    else:
        force, moment = (-my, mx, zero), (xz, yz, zz)
    own = frame.coordinate
    current: int | None = i
    while current is not None and own is not None:
        frame = frames[current]
        if frame.coordinate is not None:
            effort = force[2] if frame.prismatic else moment[2]
            matrix[own][frame.coordinate] = matrix[frame.coordinate][own] = effort
        force, moment = carried_wrench(frame, force, moment)
        current = frame.antecedent


def carried_body(frame: Frame, body: Body) -> Body:
    """A body's ten parameters in the antecedent's frame."""
    turned = body
    for pair, axes in ((frame.theta, (0, 1, 2)), (frame.alpha, (1, 2, 0)), (frame.gamma, (0, 1, 2))):
        turned = _turned(turned, pair, axes)
    return _shifted(turned, frame.origin)


_PLACE = ((0, 1, 2), (1, 3, 4), (2, 4, 5))


def _turned(body: Body, pair: tuple[Expr, Expr], axes: tuple[int, int, int]) -> Body:
    """The body turned by an angle about the axis k of the cyclic `axes` (i, j, k).

    With t = c (A - B) - 2 s H the turned plane block is B + c t, A - c t and H + s t.
    """
    s, c = pair
    if s.is_zero and c.value == 1.0:
        return body
    i, j, k = axes
    p = list(body)
    ii, jj, ij, ik, jk = _PLACE[i][i], _PLACE[j][j], _PLACE[i][j], _PLACE[i][k], _PLACE[j][k]
    a, b, h = p[ii], p[jj], p[ij]
    if c.is_zero:
        p[ii], p[jj], p[ij] = b, a, -h
    else:
        t = c * (a - b) - (s * 2.0) * h
        p[ii], p[jj], p[ij] = b + c * t, a - c * t, s * t + h
    x, y = p[ik], p[jk]
    p[ik], p[jk] = c * x - s * y, s * x + c * y
    u, v = p[6 + i], p[6 + j]
    p[6 + i], p[6 + j] = c * u - s * v, s * u + c * v
    return tuple(p)


def _shifted(body: Body, origin: Vector) -> Body:
    """The body about a point whose distance from its old origin is -`origin`.

    J' = J + 2 (P . m) 1 - (P m' + m P') + M (P . P 1 - P P'), written with m + M P / 2, once.
    """
    px, py, pz = origin
    xx, xy, xz, yy, yz, zz, mx, my, mz, m = body
    ax, ay, az = m * px, m * py, m * pz
    # products with first moments taken half way
    hx, hy, hz = mx * 2.0 + ax, my * 2.0 + ay, mz * 2.0 + az
    dx, dy, dz = px * hx, py * hy, pz * hz
    nx, ny, nz = mx + ax, my + ay, mz + az
    return (
        xx + (dy + dz),
        xy - (px * my + py * nx),
        xz - (px * mz + pz * nx),
        yy + (dx + dz),
        yz - (py * mz + pz * ny),
        zz + (dx + dy),
        nx,
        ny,
        nz,
        m,
    )


def solve(matrix: Sequence[Sequence[Expr]], right: Sequence[Expr]) -> tuple[list[Expr], list[Expr]]:
    """matrix^-1 right for a symmetric matrix, and what must be positive for it to be one of an arm.

    matrix = L' D L, unrolled from the last row to the first: that order keeps the zeros of branches
    that do not touch (Featherstone 2008, section 6.5). Positive must be every pivot, and the least of
    what they exceed VANISHED of their diagonal elements by: less is what rounding leaves of nothing,
    in arms of any size.
    """
    n = len(matrix)
    lower = [[matrix[i][j] for j in range(i + 1)] for i in range(n)]
    x = list(right)
    positive: list[Expr] = []
    left: list[Expr] = []
    for k in reversed(range(n)):
        pivot, diagonal = lower[k][k], matrix[k][k]
        positive.append(pivot)
        if pivot is not diagonal:
            left.append(pivot - diagonal * VANISHED)
        inverse = 1.0 / pivot
        for i in reversed(range(k)):
            if lower[k][i].is_zero:
                continue
            a = lower[k][i] * inverse
            for j in range(i + 1):
                lower[i][j] = lower[i][j] - a * lower[k][j]
            x[i] = x[i] - a * x[k]
            lower[k][i] = a
        x[k] = x[k] * inverse
    for k in range(n):
        for i in range(k):
            if not lower[k][i].is_zero:
                x[k] = x[k] - lower[k][i] * x[i]
    return x, positive + least(left)


def least(values: Sequence[Expr]) -> list[Expr]:
    """The least of the values, none of none: one test for all, and no branch for each."""
    found = list(values[:1])
    for x in values[1:]:
        found = [x.graph.call("min", found[0], x)]
    return found
