"""Lines in space: how two joint axes lie to each other, and their common normal."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modelgen.numeric import Array


@dataclass(frozen=True)
class Line:
    """A point (3,) [m] of it and its direction (3,), of length 1."""

    point: Array
    direction: Array

    def nearest(self, place: Array) -> Array:
        """The point of the line that is nearest to `place`."""
        return np.asarray(self.point + ((place - self.point) @ self.direction) * self.direction)


@dataclass(frozen=True)
class Axis:
    """A joint as the frames see it, drawn: its line, kind and antecedent; the frame (4, 4) of its link.

    joint: its number among those that move, None for a fixed frame between two.
    """

    line: Line
    prismatic: bool
    antecedent: int | None
    own: Array
    joint: int | None


@dataclass(frozen=True)
class Normal:
    """The common normal of two lines: its direction, and its feet on the first and the second.

    `parallel`: any place along the lines would do, the first foot is the given one. `direction` is None where
    the lines coincide: any direction across would do.
    """

    direction: Array | None
    first: Array
    second: Array
    parallel: bool


@dataclass(frozen=True)
class Nearness:
    """Below which angle [rad] two lines are parallel, and below which distance [m] they meet."""

    angle: float
    length: float


def angle_between(first: Array, second: Array) -> float:
    """Angle [rad] between two lines of these directions, whichever way they point, up to a right one."""
    return float(np.arctan2(np.linalg.norm(np.cross(first, second)), abs(first @ second)))


def common_normal(first: Line, second: Line, start: Array, near: Nearness) -> Normal:
    """The common normal; of parallel lines the one through `start`, a place on the first."""
    if angle_between(first.direction, second.direction) <= near.angle:
        foot = second.nearest(start)
        across = foot - start
        across = across - (across @ first.direction) * first.direction
        length = float(np.linalg.norm(across))
        return Normal(None if length <= near.length else across / length, start, foot, True)
    normal = np.cross(first.direction, second.direction)
    square = float(normal @ normal)
    between = second.point - first.point
    along_first = float(np.cross(between, second.direction) @ normal) / square
    along_second = float(np.cross(between, first.direction) @ normal) / square
    return Normal(
        normal / np.sqrt(square),
        first.point + along_first * first.direction,
        second.point + along_second * second.direction,
        False,
    )


def turn_about(axis: Array, start: Array, end: Array) -> float:
    """Angle [rad] by which a turn about `axis` takes `start` to `end`, both across it."""
    return float(np.arctan2(np.cross(start, end) @ axis, start @ end))


def any_across(axis: Array, wished: Array) -> Array:
    """A direction across `axis`, as near to `wished` as can be."""
    for direction in (wished, *np.eye(3)[np.argsort(np.abs(axis))]):
        across = direction - (direction @ axis) * axis
        length = np.linalg.norm(across)
        if length > 1e-6:
            return np.asarray(across / length)
    raise AssertionError("an axis is along x, y and z at once")
