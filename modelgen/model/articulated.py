"""Accelerations by articulated bodies (Featherstone 1983; 2008, chapter 7).

From the last link to the first every link takes over what the bodies beyond it resist with when their joints
give way; from the first to the last the accelerations follow. The effort grows with the number of joints,
where a mass matrix and its solution grow with its square and its cube. Inertia and bias may be those of base
parameters: links that move alike have them alike.

An articulated inertia is moment = A alpha + H a, force = H' alpha + M a, with alpha and a [rad/s^2, m/s^2] of
the origin of its frame; A and M are symmetric.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from modelgen.geometry import Frame, Frames
from modelgen.graph import Expr
from modelgen.graph.vectors import Matrix, Vector, add, cross, dot, scaled, times, transposed
from modelgen.model.composite import VANISHED, least
from modelgen.model.dynamics import Parameters
from modelgen.model.motion import LinkMotion
from modelgen.model.wrench import Wrench, carried_wrench, wrench

_Screw: TypeAlias = tuple[Vector, Vector]  # moment and force
_PLANES = ((0, 1, 2), (1, 2, 0), (0, 1, 2))  # of the turns by theta, alpha and gamma: the axis comes last


@dataclass(frozen=True)
class _Inertia:
    """A, H and M of an articulated body."""

    turning: Matrix
    coupling: Matrix
    sliding: Matrix

    def __add__(self, other: _Inertia) -> _Inertia:
        return _Inertia(
            _sum(self.turning, other.turning),
            _sum(self.coupling, other.coupling),
            _sum(self.sliding, other.sliding),
        )

    def along(self, *, prismatic: bool) -> _Screw:
        """Moment and force for a unit acceleration about z, or along it."""
        if prismatic:
            return transposed(self.coupling)[2], self.sliding[2]
        return self.turning[2], self.coupling[2]

    def yielding(self, along: _Screw, shares: _Screw) -> _Inertia:
        """Without what a joint that gives way takes off. shares: `along` over the joint's pivot."""
        return _Inertia(
            _less(self.turning, shares[0], along[0], symmetric=True),
            _less(self.coupling, shares[0], along[1]),
            _less(self.sliding, shares[1], along[1], symmetric=True),
        )

    def carried(self, frame: Frame) -> _Inertia:
        """In the antecedent's frame, about its origin."""
        turning, coupling, sliding = self.turning, self.coupling, self.sliding
        for pair, plane in zip((frame.theta, frame.alpha, frame.gamma), _PLANES, strict=True):
            turning, coupling, sliding = (_turned(x, pair, plane) for x in (turning, coupling, sliding))
        arm = _cross_matrix(frame.origin)
        moved = _sum(coupling, _product(arm, sliding))
        shift = _difference(_product(arm, transposed(moved)), _product(coupling, arm))
        return _Inertia(_mirrored(_sum(turning, shift)), moved, sliding)


def accelerations(
    frames: Frames,
    motions: Sequence[LinkMotion],
    parameters: Parameters,
    efforts: Sequence[Expr],
    drives: Sequence[Expr],
) -> tuple[list[Expr], list[Expr]]:
    """Joint accelerations, and what must be positive for them to be those of an arm.

    motions: of the links while no joint accelerates; efforts: at the joints [N m or N]; drives: inertia of
    each coordinate's drive at its joint [kg m^2 or kg]. Positive must be every pivot, and the least of what
    they exceed VANISHED of the inertia by that all links beyond the joint can have about its axis at most, in
    their order of magnitude.
    """
    zero = frames.graph.zero
    bodies = [_rigid(p, zero) for p in parameters]
    biases = [wrench(m, p, frames.arm.fluid_density) for m, p in zip(motions, parameters, strict=True)]
    sizes = [(p[5], p[9]) for p in parameters]
    joints: dict[int, _Joint] = {}
    positive: list[Expr] = []
    left: list[Expr] = []
    for i in reversed(frames.order):
        frame, body, bias = frames[i], bodies[i], biases[i]
        if frame.coordinate is not None:
            drive, effort = drives[frame.coordinate], efforts[frame.coordinate]
            joints[i] = joint = _joint(body.along(prismatic=frame.prismatic), bias, frame, effort, drive)
            positive.append(joint.pivot)
            size = sizes[i][frame.prismatic] + drive
            if size.key != joint.pivot.key:
                left.append(joint.pivot - size * VANISHED)
            if frame.antecedent is not None:
                body, bias = body.yielding(joint.along, joint.shares), joint.passed_on(bias, effort)
        if frame.antecedent is not None:
            bodies[frame.antecedent] = bodies[frame.antecedent] + body.carried(frame)
            biases[frame.antecedent] = _joined(biases[frame.antecedent], frame, bias)
            sizes[frame.antecedent] = _larger(sizes[frame.antecedent], sizes[i], frame)
    return _outwards(frames, joints), positive + least(left)


@dataclass(frozen=True)
class _Joint:
    """A joint on its articulated body.

    along: moment and force for a unit acceleration; pivot: inertia against its drive's effort [kg m^2 or kg];
    shares: along over the pivot; missing: effort that is left to accelerate it; alone: whether its drive has
    no inertia, so that the body resists nothing along it.
    """

    along: _Screw
    pivot: Expr
    shares: _Screw
    missing: Expr
    prismatic: bool
    alone: bool

    def passed_on(self, bias: Wrench, effort: Expr) -> Wrench:
        """The bias of the body where the joint gives way to `effort`."""
        force, moment = (
            _taken_up(given, share, self.missing)
            for given, share in zip(bias, (self.shares[1], self.shares[0]), strict=True)
        )
        if self.alone and self.prismatic:
            force = (force[0], force[1], effort)
        elif self.alone:
            moment = (moment[0], moment[1], effort)
        return force, moment


def _joint(along: _Screw, bias: Wrench, frame: Frame, effort: Expr, drive: Expr) -> _Joint:
    place = int(frame.prismatic)
    pivot = along[place][2] + drive
    inverse = 1.0 / pivot
    shares = [scaled(inverse, v) for v in along]
    if drive.is_zero:
        shares[place] = (shares[place][0], shares[place][1], inverse.graph.one)
    force, moment = bias
    missing = effort - (force[2] if frame.prismatic else moment[2])
    return _Joint(along, pivot, (shares[0], shares[1]), missing, frame.prismatic, drive.is_zero)


def _outwards(frames: Frames, joints: Mapping[int, _Joint]) -> list[Expr]:
    """Accelerations of the joints, which are given by link."""
    zero = frames.graph.zero
    found = [zero] * len(frames.coordinates)
    still: Vector = (zero, zero, zero)
    moving: dict[int | None, _Screw] = {None: (still, still)}
    for i in frames.order:
        frame = frames[i]
        turning, sliding = moving[frame.antecedent]
        sliding = frame.to_link(add(sliding, cross(turning, frame.origin)))
        motion = [frame.to_link(turning), sliding]
        if frame.coordinate is not None:
            joint, place = joints[i], int(frame.prismatic)
            x, y, z = motion[place]
            if joint.alone:  # what it takes of the motion of the link before it cancels
                motion[place] = (x, y, zero)
            resists = dot(joint.along[0], motion[0]) + dot(joint.along[1], motion[1])
            own = (joint.missing - resists) * (1.0 / joint.pivot)
            found[frame.coordinate] = own - z if joint.alone else own
            motion[place] = (x, y, own if joint.alone else z + own)
        moving[i] = motion[0], motion[1]
    return found


def _rigid(p: Sequence[Expr], zero: Expr) -> _Inertia:
    """Of a link by itself."""
    xx, xy, xz, yy, yz, zz, mx, my, mz, m = p[:10]
    return _Inertia(
        ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz)),
        _cross_matrix((mx, my, mz)),
        ((m, zero, zero), (zero, m, zero), (zero, zero, m)),
    )


def _joined(bias: Wrench, frame: Frame, more: Wrench) -> Wrench:
    """A link's bias with that of a body that it carries."""
    back, turned = carried_wrench(frame, *more)
    return add(bias[0], back), add(bias[1], turned)


def _larger(size: tuple[Expr, Expr], more: tuple[Expr, Expr], frame: Frame) -> tuple[Expr, Expr]:
    """Orders of magnitude of inertia and mass [kg m^2, kg] of a link with what it carries."""
    (inertia, mass), (further, extra) = size, more
    return inertia + further + extra * dot(frame.origin, frame.origin), mass + extra


def _taken_up(bias: Vector, share: Vector, missing: Expr) -> Vector:
    """The bias with what a joint that gives way passes on."""
    return add(bias, scaled(missing, share))


def _turned(x: Matrix, pair: tuple[Expr, Expr], plane: tuple[int, int, int]) -> Matrix:
    """R x R' for a turn by an angle about the axis k of the cyclic `plane` (i, j, k).

    With t = c (x_ii - x_jj) - s (x_ij + x_ji) the turned block is x_jj + c t, x_ii - c t, x_ij + s t and
    x_ji + s t: of a tensor in a plane a turn leaves trace and antisymmetric part alone.
    """
    s, c = pair
    if s.is_zero and c.value == 1.0:
        return x
    i, j, k = plane
    new = [list(row) for row in x]
    if c.is_zero:
        new[i][i], new[j][j], new[i][j], new[j][i] = x[j][j], x[i][i], -x[j][i], -x[i][j]
    else:
        t = c * (x[i][i] - x[j][j]) - s * (x[i][j] + x[j][i])
        new[i][i], new[j][j] = x[j][j] + c * t, x[i][i] - c * t
        new[i][j], new[j][i] = s * t + x[i][j], s * t + x[j][i]
    new[i][k], new[j][k] = c * x[i][k] - s * x[j][k], s * x[i][k] + c * x[j][k]
    new[k][i], new[k][j] = c * x[k][i] - s * x[k][j], s * x[k][i] + c * x[k][j]
    return _matrix(new)


def _less(x: Matrix, left: Sequence[Expr], right: Sequence[Expr], *, symmetric: bool = False) -> Matrix:
    """x - left right'; below the diagonal as above it where symmetric."""
    new = [[x[r][c] - left[r] * right[c] for c in range(3)] for r in range(3)]
    return _mirrored(_matrix(new)) if symmetric else _matrix(new)


def _cross_matrix(v: Vector) -> Matrix:
    zero = v[0] * 0.0
    return ((zero, -v[2], v[1]), (v[2], zero, -v[0]), (-v[1], v[0], zero))


def _product(a: Matrix, b: Matrix) -> Matrix:
    return transposed(_matrix([times(a, column) for column in transposed(b)]))


def _sum(a: Matrix, b: Matrix) -> Matrix:
    return _matrix([add(x, y) for x, y in zip(a, b, strict=True)])


def _difference(a: Matrix, b: Matrix) -> Matrix:
    return _matrix([[x - y for x, y in zip(r, s, strict=True)] for r, s in zip(a, b, strict=True)])


def _mirrored(x: Matrix) -> Matrix:
    """Symmetric, by what is on and below the diagonal.

    A joint without inertia of its own makes the last row exactly zero, the last column but for rounding.
    """
    return ((x[0][0], x[1][0], x[2][0]), (x[1][0], x[1][1], x[2][1]), (x[2][0], x[2][1], x[2][2]))


def _matrix(rows: Sequence[Sequence[Expr]]) -> Matrix:
    (a, b, c), (d, e, f), (g, h, i) = rows
    return (a, b, c), (d, e, f), (g, h, i)
