"""A linear actuator on a lever: the triangle of its two ends and the joint's axis."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import sympy as sp

from modelgen.symbolic import Range, Scalar

CLEARANCE = 1e-4  # of both lengths together, that a stroke keeps from where they lie in line


@dataclass(frozen=True)
class Actuator:
    """One end lies on the link before the joint, at l1 from the joint's axis, the other on its own at l2 [m].

    q = rev q_j + offset [rad] with q_j the angle at the axis, in (0, pi). Its length runs from length[0] to
    length[1] [m] while the motor coordinate runs from motor[0] to motor[1].
    """

    l1: Scalar
    l2: Scalar
    length: tuple[Scalar, Scalar]
    motor: Range
    rev: int
    offset: Scalar

    def angle(self, q: sp.Expr) -> sp.Expr:
        """Angle at the joint's axis between the directions of the actuator's two ends [rad]."""
        return q - self.offset

    def square(self, q: sp.Expr) -> sp.Expr:
        """Square of the length at q [m^2], by the law of cosines."""
        l1, l2 = sp.sympify(self.l1), sp.sympify(self.l2)
        return l1**2 + l2**2 - 2 * l1 * l2 * sp.cos(self.angle(q))

    def cosine(self, length: sp.Expr) -> sp.Expr:
        """Cosine of q_j at a length [m]."""
        l1, l2 = sp.sympify(self.l1), sp.sympify(self.l2)
        return (l1**2 + l2**2 - length**2) / (2 * l1 * l2)

    def direction(self, q: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """Vector from its base to its other end [m], along the line from axis to base and across it."""
        l1, l2, angle = sp.sympify(self.l1), sp.sympify(self.l2), self.angle(q)
        return l2 * sp.cos(angle) - l1, l2 * sp.sin(angle)

    def turn(self, q: sp.Expr) -> sp.Expr:
        """Angle by which it swings about its base, per angle of the joint."""
        l1, l2 = sp.sympify(self.l1), sp.sympify(self.l2)
        return (l2**2 - l1 * l2 * sp.cos(self.angle(q))) / self.square(q)

    def lengthened(self, l1: float, l2: float, length: float) -> Actuator:
        """The actuator with these lengths longer [m]; where all are numbers, on the part of the stroke on
        which the triangle closes. Raises ValueError where there is none.
        """
        low, high = (end + length for end in self.length)
        found = replace(self, l1=self.l1 + l1, l2=self.l2 + l2, length=(low, high))
        if all(isinstance(x, float) for x in (found.l1, found.l2, low, high)):
            return found._closed()
        return found

    def _closed(self) -> Actuator:
        l1, l2, *ends = (float(x) for x in (self.l1, self.l2, *self.length))
        spare = CLEARANCE * (l1 + l2)
        shortest, longest = abs(l1 - l2) + spare, l1 + l2 - spare
        inside = [min(max(end, shortest), longest) for end in ends]
        if min(l1, l2) <= 0 or inside[0] == inside[1]:
            raise ValueError("these lengths leave no triangle anywhere on the stroke")
        if inside == ends:
            return self
        per_length = (self.motor[1] - self.motor[0]) / (ends[1] - ends[0])
        first, last = (self.motor[0] + per_length * (end - ends[0]) for end in inside)
        return replace(self, length=(inside[0], inside[1]), motor=(first, last))


def inner_angle(l1: float, l2: float, length: float) -> float:
    """Angle [rad] at the joint axis of the triangle l1, l2, length [m] (law of cosines), within [0, pi]."""
    # The squares are taken of ratios, so that no length is too large or too small for them.
    cosine = (l1 / l2 + l2 / l1 - (length / l1) * (length / l2)) / 2
    return math.acos(min(1.0, max(-1.0, cosine)))
