"""Inverse dynamics, regressor, mass matrix and energy of the rigid bodies, drives apart."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from modelgen.geometry import Frames
from modelgen.graph import Expr
from modelgen.graph.vectors import Vector, add, cross
from modelgen.model.motion import LinkMotion
from modelgen.model.screws import partial_velocities
from modelgen.model.wrench import Wrench, projected_columns, wrench

Parameters = Sequence[Sequence[Expr]]  # link by link: 10, or 14 in a fluid


def joint_efforts(frames: Frames, motions: Sequence[LinkMotion], parameters: Parameters) -> list[Expr]:
    """Effort of every coordinate [N m or N]: backward recursion (Luh, Walker and Paul 1980)."""
    graph, density = frames.graph, frames.arm.fluid_density
    zero: Vector = (graph.zero, graph.zero, graph.zero)
    total: dict[int | None, Wrench] = {None: (zero, zero)}
    for i, motion in enumerate(motions):
        total[i] = wrench(motion, parameters[i], density)
    efforts = [graph.zero] * len(frames.coordinates)
    for i in reversed(frames.order):
        frame = frames[i]
        force, moment = total[i]
        if frame.coordinate is not None:
            efforts[frame.coordinate] = force[2] if frame.prismatic else moment[2]
        if frame.antecedent is not None:
            f, n = total[frame.antecedent]
            back = frame.to_antecedent(force)
            turned = add(frame.to_antecedent(moment), cross(frame.origin, back))
            total[frame.antecedent] = add(f, back), add(n, turned)
    return efforts


def regressor_columns(
    frames: Frames, motions: Sequence[LinkMotion], slid: Collection[int] = ()
) -> list[list[list[Expr]]]:
    """[coordinate][link][parameter]: effort per unit of each standard parameter.

    The links in `slid` are projected at the foot of the common normal instead of their origin.
    """
    graph, density = frames.graph, frames.arm.fluid_density
    count = 14 if density else 10
    empty = [graph.zero] * count
    table = [[empty for _ in motions] for _ in frames.coordinates]
    for i, own in enumerate(partial_velocities(frames, slid)):
        slide = frames[i].r if i in slid else graph.zero
        for n, screw in own.items():
            table[n][i] = projected_columns(motions[i], screw, count, density, slide)
    return table


def inertial_parameters_turned(p: Sequence[Expr], pair: tuple[Expr, Expr], axes: tuple[int, int, int]) -> list[Expr]:
    """Ten parameters of a body in a frame turned by an angle about one axis: v' = Rot v.

    `axes` is a cyclic order (i, j, k) with k the axis of the rotation. The two-by-two block is
    turned with half the usual products: t = c (A - B) - 2 s H gives A', B' and H' alike.
    """
    s, c = pair
    i, j, k = axes
    tensor = {(0, 0): p[0], (0, 1): p[1], (0, 2): p[2], (1, 1): p[3], (1, 2): p[4], (2, 2): p[5]}

    def at(a: int, b: int) -> tuple[int, int]:
        return (a, b) if a <= b else (b, a)

    a, b, h = tensor[at(i, i)], tensor[at(j, j)], tensor[at(i, j)]
    t = c * (a - b) - (s * 2.0) * h
    tensor[at(i, i)], tensor[at(j, j)], tensor[at(i, j)] = b + c * t, a - c * t, s * t + h
    x, y = tensor[at(i, k)], tensor[at(j, k)]
    tensor[at(i, k)], tensor[at(j, k)] = c * x - s * y, s * x + c * y
    moments = [p[6], p[7], p[8]]
    moments[i], moments[j] = c * moments[i] - s * moments[j], s * moments[i] + c * moments[j]
    return [*tensor.values(), *moments, p[9]]
