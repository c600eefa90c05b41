"""Inverse dynamics, regressor, mass matrix and energy of the rigid bodies, drives apart."""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.geometry import Frames
from modelgen.graph import Expr
from modelgen.graph.vectors import Vector, add
from modelgen.model.motion import LinkMotion
from modelgen.model.wrench import Wrench, carried_wrench, wrench

Parameters = Sequence[Sequence[Expr]]  # link by link: 10, or 14 in a fluid


def joint_efforts(frames: Frames, motions: Sequence[LinkMotion], parameters: Parameters) -> list[Expr]:
    """Effort of every coordinate [N m or N]: backward recursion (Luh, Walker and Paul 1980)."""
    efforts = [frames.graph.zero] * len(frames.coordinates)
    for frame, (force, moment) in zip(frames.frames, wrenches(frames, motions, parameters), strict=True):
        if frame.coordinate is not None:
            efforts[frame.coordinate] = force[2] if frame.prismatic else moment[2]
    return efforts


def wrenches(frames: Frames, motions: Sequence[LinkMotion], parameters: Parameters) -> list[Wrench]:
    """Wrench that every joint passes on to its link and all beyond it, at the link's origin in its axes."""
    graph, density = frames.graph, frames.arm.fluid_density
    zero: Vector = (graph.zero, graph.zero, graph.zero)
    total: dict[int | None, Wrench] = {None: (zero, zero)}
    for i, motion in enumerate(motions):
        with frames.noted(i, "force and moment"):
            total[i] = wrench(motion, parameters[i], density)
    for i in reversed(frames.order):
        frame = frames[i]
        if frame.antecedent is not None:
            force, moment = total[i]
            f, n = total[frame.antecedent]
            with frames.noted(i, "what it passes on"):
                back, turned = carried_wrench(frame, force, moment)
                total[frame.antecedent] = add(f, back), add(n, turned)
    return [total[i] for i in range(len(motions))]
