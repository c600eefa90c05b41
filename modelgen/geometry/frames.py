"""The frames of an arm by modified DH (Khalil and Kleinfinger 1986), in the expression graph.

T(antecedent -> j) = Rot(z, gamma) Trans(z, b) Rot(x, alpha) Trans(x, d) Rot(z, theta) Trans(z, r).
Vectors are turned by one plane rotation after the other: a right angle then costs nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass

from modelgen.description.objects import Arm, Joint
from modelgen.geometry.scalars import Scalars
from modelgen.geometry.trigonometry import Trigonometry
from modelgen.graph import Expr
from modelgen.graph.vectors import Vector

Pair = tuple[Expr, Expr]  # sine, cosine


def turn_z(pair: Pair, v: Vector) -> Vector:
    """Rot(z) v."""
    s, c = pair
    return (c * v[0] - s * v[1], s * v[0] + c * v[1], v[2])


def turn_z_factored(pair: Pair, v: Vector) -> Vector:
    """Rot(z) v, with a factor common to both components put outside first.

    A vector known up to a factor (the first axis of an arm, say) is then turned once for all that is
    proportional to it.
    """
    graph = v[0].graph
    shared = graph.common_factor(v[0], v[1])
    if shared is None:
        return turn_z(pair, v)
    factor, x, y = shared
    tx, ty, _ = turn_z(pair, (x, y, v[2]))
    return (factor * tx, factor * ty, v[2])


def turn_x(pair: Pair, v: Vector) -> Vector:
    """Rot(x) v."""
    s, c = pair
    return (v[0], c * v[1] - s * v[2], s * v[1] + c * v[2])


def _back(pair: Pair) -> Pair:
    return -pair[0], pair[1]


@dataclass(frozen=True)
class Frame:
    """Frame j as seen from its antecedent; `coordinate` is None where it does not move."""

    index: int
    antecedent: int | None
    coordinate: int | None
    prismatic: bool
    gamma: Pair
    alpha: Pair
    theta: Pair
    foot: Vector  # of the common normal on the axis of joint j, in the antecedent's frame [m]
    origin: Vector  # of frame j, in the antecedent's frame [m]
    factored: bool  # take common factors out of what is turned
    r: Expr  # from the foot to the origin along z of frame j [m]

    def to_link(self, v: Vector) -> Vector:
        """A free vector of the antecedent's frame in frame j."""
        turn = turn_z_factored if self.factored else turn_z
        return turn(_back(self.theta), turn_x(_back(self.alpha), turn_z(_back(self.gamma), v)))

    def to_antecedent(self, v: Vector) -> Vector:
        """A free vector of frame j in the antecedent's frame."""
        return turn_z(self.gamma, turn_x(self.alpha, turn_z(self.theta, v)))

    def to_antecedent_fixed(self, v: Vector) -> Vector:
        """Like `to_antecedent`, without theta where the joint turns: a turn leaves these directions alone."""
        turning = self.coordinate is not None and not self.prismatic
        return turn_z(self.gamma, turn_x(self.alpha, v if turning else turn_z(self.theta, v)))


class Frames:
    """All frames of an arm; `frames[i]` belongs to `arm.joints[i]`, `order` lists antecedents first.

    lag_rates: rates at which links stay behind their drives, by coordinate.
    """

    def __init__(
        self,
        arm: Arm,
        scalars: Scalars,
        trigonometry: Trigonometry,
        factored: bool = False,
        lag_rates: Mapping[int, Expr] | None = None,
    ) -> None:
        self.lag_rates = lag_rates or {}
        self.factored = factored
        self.arm = arm
        self.graph = scalars.graph
        self.scalars = scalars
        self.trigonometry = trigonometry
        self.order = arm.order
        self.coordinates = arm.coordinates
        number = {i: n for n, i in enumerate(arm.coordinates)}
        self.frames = [self._frame(i, joint, number.get(i)) for i, joint in enumerate(arm.joints)]

    def noted(self, index: int, text: str) -> AbstractContextManager[None]:
        """What is made meanwhile in the graph belongs to a link, and to what the text says of it."""
        return self.graph.noted(f"link {self.arm.joints[index].name}: {text}")

    def __getitem__(self, index: int) -> Frame:
        return self.frames[index]

    def _frame(self, index: int, joint: Joint, coordinate: int | None) -> Frame:
        scalars = self.scalars
        prismatic = joint.type == "prismatic"
        offset = 0.0 if joint.locked is None else joint.locked
        r = scalars(joint.r)
        if coordinate is None:
            theta = scalars.sin_cos(joint.theta if prismatic else joint.theta + offset)
            r = r + offset if prismatic else r
        elif prismatic:
            theta = scalars.sin_cos(joint.theta)
            r = r + self.graph.input("q", coordinate)
            if coordinate in self.trigonometry.lags:
                r = r - self.trigonometry.lags[coordinate]
        else:
            theta = self.trigonometry.of(coordinate, joint.theta)
        alpha, gamma = scalars.sin_cos(joint.alpha), scalars.sin_cos(joint.gamma)
        zero = self.graph.zero
        d, b = scalars(joint.d), scalars(joint.b)
        along = turn_x(alpha, (zero, zero, r))
        foot = turn_z(gamma, (d, zero, b))
        origin = turn_z(gamma, (d + along[0], along[1], along[2] + b))
        return Frame(
            index,
            joint.antecedent,
            coordinate,
            prismatic,
            gamma,
            alpha,
            theta,
            foot,
            origin,
            self.factored,
            r,
        )

    def path(self, index: int) -> list[int]:
        """Indices of the frames from the base to `index`."""
        chain: list[int] = []
        current: int | None = index
        while current is not None:
            chain.append(current)
            current = self.frames[current].antecedent
        return chain[::-1]
