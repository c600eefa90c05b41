"""Frames by modified Denavit-Hartenberg parameters for a tree of axes (Khalil and Kleinfinger, 1986).

z of frame j is the axis of joint j, its direction the source's, so that coordinates agree. x of frame j lies
along the common normal to the axis of one joint that it carries, the main one: that joint then needs neither
gamma nor b. What the rules leave free is chosen for cheap code, as one would by hand:

- parallel axes: the normal goes through the foot of the one before, so that r = 0 until the last of them;
- axes that coincide: x as in the frame before, theta = 0;
- prismatic joints, whose axis may lie anywhere: on the axis that they carry where that is parallel, else
  through a place that has a name already;
- the last joints: at the origin of the source's own frame, x along one of its axes where that makes theta a
  multiple of a right angle.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from modelgen.importing.axes import Axis, Line, Nearness, any_across, common_normal, turn_about
from modelgen.importing.helpers import with_helpers
from modelgen.importing.poses import pose, rotation
from modelgen.importing.rounded import near_angle, near_zero
from modelgen.numeric import Array


@dataclass(frozen=True)
class Parameters:
    """The six of Khalil and Kleinfinger, rad and m, of the drawn pose."""

    gamma: float
    b: float
    alpha: float
    d: float
    theta: float
    r: float

    def transform(self, turn: float = 0.0, slide: float = 0.0) -> Array:
        """Antecedent <- frame (4, 4), with `turn` [rad] added to theta and `slide` [m] to r."""
        first = pose(rotation(2, self.gamma), np.array([0.0, 0.0, self.b]))
        second = pose(rotation(0, self.alpha), np.array([self.d, 0.0, 0.0]))
        third = pose(rotation(2, self.theta + turn), np.array([0.0, 0.0, self.r + slide]))
        return np.asarray(first @ second @ third)


@dataclass(frozen=True)
class Placed:
    """All frames of an arm: base (4, 4) in the root, parameters, and frames (4, 4) in the root, drawn.

    `axes` are those that were given and, with `joint` None, helpers between them. snapped: how far [rad, m]
    the parameters are from what the axes give, largest.
    """

    base: Array
    axes: tuple[Axis, ...]
    parameters: tuple[Parameters, ...]
    frames: tuple[Array, ...]
    snapped: float


def place_frames(axes: Sequence[Axis], near: Nearness) -> Placed:
    """Frames for a tree of axes, antecedents first; angles and lengths nearer than `near` are made exact."""
    return _Placing(axes, near).placed()


class _Placing:
    def __init__(self, given: Sequence[Axis], near: Nearness) -> None:
        self.near = near
        self.snapped = 0.0
        size = _sizes(given)
        roots = [i for i, axis in enumerate(given) if axis.antecedent is None]
        first = given[max(roots, key=lambda i: size[i])]
        upright = self._approach(first.line, np.eye(4))
        self.own_base = not (_right(upright[0]) and _right(upright[2]))
        ground = first.line if self.own_base else Line(np.zeros(3), np.array([0.0, 0.0, 1.0]))
        self.axes = with_helpers(given, ground, near)
        self.first = next(i for i, axis in enumerate(self.axes) if axis.joint == first.joint)
        size = _sizes(self.axes)
        carried: list[list[int]] = [[] for _ in self.axes]
        for i, axis in enumerate(self.axes):
            if axis.antecedent is not None:
                carried[axis.antecedent].append(i)
        # the main one of those that a joint carries is the one that carries most
        self.main = [max(below, key=lambda i: size[i], default=None) for below in carried]
        for i in reversed(range(len(self.axes))):
            if self.axes[i].prismatic:
                self._settle(i)

    def _settle(self, i: int) -> None:
        """Where the axis of a prismatic joint lies: what it carries is settled before."""
        axis, main = self.axes[i], self.main[i]
        if main is None:
            return
        line = self.axes[main].line
        place = line.point
        following = self.main[main]
        if following is not None:
            place = common_normal(line, self.axes[following].line, line.point, self.near).first
        self.axes[i] = replace(axis, line=Line(place, axis.line.direction))

    def placed(self) -> Placed:
        """The frames."""
        base = self._base()
        frames: list[Array] = []
        parameters: list[Parameters] = []
        for i in range(len(self.axes)):
            above = self.axes[i].antecedent
            before = base if above is None else frames[above]
            if self.axes[i].prismatic and self.main[i] is None:
                self.axes[i] = self._last_slide(self.axes[i], before)
            found, frame = self._parameters(i, before)
            parameters.append(found)
            frames.append(frame)
        return Placed(base, tuple(self.axes), tuple(parameters), tuple(frames), self.snapped)

    def _last_slide(self, axis: Axis, before: Array) -> Axis:
        """A slide that carries nothing goes through the origin before it."""
        return replace(axis, line=Line(before[:3, 3].copy(), axis.line.direction))

    def _base(self) -> Array:
        """The root itself where right angles lead from there to the first axis, else a frame on that."""
        if not self.own_base:
            return np.eye(4)
        axis = self.axes[self.first]
        z = axis.line.direction
        x = any_across(z, axis.own[:3, 0])
        start = pose(np.column_stack([x, np.cross(z, x), z]), axis.line.point)
        return self._parameters(self.first, start)[1]

    def _approach(self, line: Line, before: Array) -> tuple[float, float, float, float, Array, Array]:
        """gamma, b, alpha, d that lead from a frame to a line; the foot on the line, and x there."""
        z, x, origin = before[:3, 2], before[:3, 0], before[:3, 3]
        found = common_normal(Line(origin, z), line, origin, self.near)
        direction = x if found.direction is None else found.direction
        gamma = turn_about(z, x, direction)
        if abs(gamma) > math.pi / 2 + 1e-9:
            # of the two directions along the normal the one that leaves gamma alone, or nearly
            direction = -direction
            gamma = turn_about(z, x, direction)
        gamma = self._angle(gamma)
        b = self._length(float((found.first - origin) @ z))
        alpha = self._angle(turn_about(direction, z, line.direction))
        d = self._length(float((found.second - found.first) @ direction))
        return gamma, b, alpha, d, found.second, direction

    def _parameters(self, i: int, before: Array) -> tuple[Parameters, Array]:
        """Parameters of frame i, and the frame itself: what they round does not move what comes after."""
        z = self.axes[i].line.direction
        gamma, b, alpha, d, foot, x = self._approach(self.axes[i].line, before)
        origin, direction = self._onward(i, foot, x)
        theta = self._angle(turn_about(z, x, direction))
        r = self._length(float((origin - foot) @ z))
        turn = np.column_stack([direction, np.cross(z, direction), z])
        return Parameters(gamma, b, alpha, d, theta, r), pose(turn, origin)

    def _angle(self, value: float) -> float:
        exact = near_angle(value, self.near.angle)
        self.snapped = max(self.snapped, abs(exact - value))
        return exact

    def _length(self, value: float) -> float:
        exact = near_zero(value, self.near.length)
        self.snapped = max(self.snapped, abs(exact - value))
        return exact

    def _onward(self, i: int, foot: Array, x: Array) -> tuple[Array, Array]:
        """Origin and x of frame i, whose normal from before has its foot there, along x."""
        axis, main = self.axes[i], self.main[i]
        z = axis.line.direction
        if main is None:
            return self._end(axis, foot, x)
        found = common_normal(Line(foot, z), self.axes[main].line, foot, self.near)
        if found.direction is None:
            return foot, x
        turn = turn_about(z, x, found.direction)
        # of the two directions the one that turns x less, forwards where both do as much
        back = abs(turn) > math.pi / 2 + 1e-9 or abs(turn + math.pi / 2) <= 1e-9
        return found.first, -found.direction if back else found.direction

    def _end(self, axis: Axis, foot: Array, x: Array) -> tuple[Array, Array]:
        """Of a joint that carries no other: the frame of its link in the source, as far as it can be."""
        z, own = axis.line.direction, axis.own
        origin = foot if axis.prismatic else axis.line.nearest(own[:3, 3])
        for column in (own[:3, 0], own[:3, 1]):
            if abs(column @ z) < 1e-9 and _right(near_angle(turn_about(z, x, column), self.near.angle)):
                return origin, column
        return origin, x


def _sizes(axes: Sequence[Axis]) -> list[int]:
    """How many joints each carries, itself counted."""
    size = [1] * len(axes)
    for i in reversed(range(len(axes))):
        above = axes[i].antecedent
        if above is not None:
            size[above] += size[i]
    return size


def _right(angle: float) -> bool:
    """Whether an angle is a multiple of a right one: it costs nothing."""
    return abs(math.remainder(angle, math.pi / 2)) < 1e-12
