"""Axes that are parallel by a hair: their common normal lies far away, where a frame has no business.

A calibrated arm has such axes, and so has a drawing with 1.57 for a right angle. A fixed frame between the
two, its z across both, keeps all figures as small as the arm (the reason is that of Hayati, 1983).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modelgen.importing.axes import Axis, Line, Nearness, angle_between, any_across, common_normal
from modelgen.importing.poses import pose
from modelgen.numeric import Array

FAR = 10.0  # a foot farther off than that many times the arm's largest step between joints
SLIDE = 1e-3  # rad; a slide may be moved, so that only its direction counts


def with_helpers(axes: Sequence[Axis], base: Line, near: Nearness) -> list[Axis]:
    """The axes, with a fixed one before each that is nearly but not quite parallel to its antecedent's.

    base: the z axis of the base frame.
    """
    ground = Axis(base, False, None, pose(np.eye(3), base.point), joint=None)
    size = max((float(np.linalg.norm(_step(axes, axis))) for axis in axes), default=0.0)
    result: list[Axis] = []
    place: list[int] = []
    for axis in axes:
        before = None if axis.antecedent is None else place[axis.antecedent]
        carrier = ground if before is None else result[before]
        if _far(carrier, axis, size, near):
            result.append(_helper(carrier, axis, before, size))
            before = len(result) - 1
        result.append(replace(axis, antecedent=before))
        place.append(len(result) - 1)
    return result


def _step(axes: Sequence[Axis], axis: Axis) -> Array:
    start = np.zeros(3) if axis.antecedent is None else axes[axis.antecedent].line.point
    return np.asarray(axis.line.point - start)


def _far(before: Axis, axis: Axis, size: float, near: Nearness) -> bool:
    angle = angle_between(before.line.direction, axis.line.direction)
    if angle <= near.angle:
        return False
    if axis.prismatic or before.prismatic:
        return angle < SLIDE
    normal = common_normal(before.line, axis.line, before.line.point, near)
    feet = (normal.first - before.line.point, normal.second - axis.line.point)
    return max(float(np.linalg.norm(foot)) for foot in feet) > FAR * size


def _helper(before: Axis, axis: Axis, index: int | None, size: float) -> Axis:
    """Through both axes where they stand apart, else across the first."""
    start = before.line.nearest(axis.line.point)
    apart = axis.line.point - start
    distance = float(np.linalg.norm(apart))
    if distance > 1e-6 * size:
        direction = apart / distance
    else:
        direction = any_across(before.line.direction, np.array([1.0, 0.0, 0.0]))
    return Axis(Line(start, direction), False, index, pose(np.eye(3), start), joint=None)
