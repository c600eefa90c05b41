"""The levered drive: a linear actuator between two points at l1 and l2 from the axis of a revolute joint."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated, Self

import sympy as sp

from modelgen.symbolic import Range, Scalar
from modelgen.transmission.actuator import Actuator, inner_angle
from modelgen.transmission.bars import AXIS, Bar, Point
from modelgen.transmission.drive import NO_LIMITS, Drive, MotorLimits
from modelgen.transmission.figures import Figure, FigureError

# Nearer than this to a dead centre the lever passes on next to no effort, and rounding decides its branch.
DEAD_CENTRE_MARGIN = math.radians(0.5)


@dataclass(frozen=True)
class LeveredDrive(Drive):
    """Linear actuator of length q_p between points at l1 and l2 [m] from the joint axis, q_p affine in q_m.

    q = rev q_j + offset with q_j the inner angle in (0, pi); q_p runs from length[0] to length[1] while q_m
    runs from motor[0] to motor[1]. `torque_constant` in J per motor unit per A. Leborne, Creuze, Chemori and
    Brignone (2018); docs/theory.md says where the printed equations differ.
    """

    name = "levered"
    text = "a linear actuator between two points at l1 and l2 from the axis of a revolute joint"
    unit = "unit"
    force_unit = "J per motor unit per A"
    joint_type = "revolute"
    origin = "offset"
    runtime = ("l1", "l2", "length", "offset")
    typical_inertia = 1e-8
    decides_reach = "length, rev or offset"
    decides_motor = "the lever's lengths"

    l1: Annotated[
        Scalar,
        Figure("length", "Distance from the joint axis to one end of the actuator [m].", must="positive"),
    ]
    l2: Annotated[
        Scalar,
        Figure(
            "length", "Distance from the joint axis to the other end of the actuator [m].", must="positive"
        ),
    ]
    length: Annotated[
        tuple[Scalar, Scalar],
        Figure("length", "Actuator length at the two values of `motor` [m].", must="positive", pair=True),
    ]
    motor: Annotated[
        Range,
        Figure(
            "plain",
            "Motor coordinate at the two lengths [any unit, increments usually].",
            pair=True,
            symbolic=False,
        ),
    ]
    rev: Annotated[int, Figure("sign", "Branch: q = rev q_j + offset, q_j the inner angle of the lever.")]
    offset: Annotated[Scalar, Figure("angle", "Joint angle minus rev times the lever's inner angle [rad].")]
    torque_constant: float
    limits: MotorLimits = NO_LIMITS

    @property
    def actuator(self) -> Actuator:
        """It."""
        return Actuator(self.l1, self.l2, self.length, self.motor, self.rev, self.offset)

    def with_actuator(self, actuator: Actuator) -> Self:
        """The drive with another actuator."""
        return replace(
            self,
            l1=actuator.l1,
            l2=actuator.l2,
            length=actuator.length,
            motor=actuator.motor,
            rev=actuator.rev,
            offset=actuator.offset,
        )

    def linkage(self, q: sp.Expr) -> tuple[Bar, ...]:
        """The triangle: both levers, and the actuator between their ends."""
        angle = self.actuator.angle(q)
        base: Point = (sp.sympify(self.l1), sp.Integer(0))
        end: Point = (self.l2 * sp.cos(angle), self.l2 * sp.sin(angle))
        return (
            Bar("l1", "before", AXIS, base),
            Bar("l2", "own", AXIS, end),
            Bar("actuator", "between", base, end, telescopes=True),
        )

    @property
    def _per_length(self) -> sp.Expr:
        """Motor coordinate per length [unit/m]."""
        return (self.motor[1] - self.motor[0]) / sp.sympify(self.length[1] - self.length[0])

    def of_length(self) -> tuple[sp.Expr, sp.Expr]:
        """(m1 - m0) / (L1 - L0), and m0 less that times L0."""
        return self._per_length, self.motor[0] - self._per_length * self.length[0]

    def motor_from_joint(self, q: sp.Expr) -> sp.Expr:
        """q_m = m0 + (m1 - m0) (q_p - L0) / (L1 - L0)."""
        return self.motor[0] + self._per_length * (sp.sqrt(self.actuator.square(q)) - self.length[0])

    def _length(self, q_m: sp.Expr) -> sp.Expr:
        """q_p [m] as a function of q_m."""
        return self.length[0] + (q_m - self.motor[0]) / self._per_length

    def joint_from_motor(self, q_m: sp.Expr) -> sp.Expr:
        """q = rev arccos((l1^2 + l2^2 - q_p^2) / (2 l1 l2)) + offset."""
        return self.rev * sp.acos(self.actuator.cosine(self._length(q_m))) + self.offset

    def inverse_gain(self, q: sp.Symbol) -> sp.Expr:
        """1/K = q_p / (torque_constant (m1 - m0)/(L1 - L0) l1 l2 sin(q - offset)): one division."""
        scale = self.torque_constant * self._per_length * sp.sympify(self.l1) * sp.sympify(self.l2)
        return sp.sqrt(self.actuator.square(q)) / (scale * sp.sin(self.actuator.angle(q)))

    def guards(self, q: sp.Expr) -> tuple[sp.Expr, ...]:
        """(q_p - L0) (L1 - q_p), widened by a thousandth of the stroke [m^2], and rev sin(q - offset): on
        the stroke, and on the lever's own side of its dead centres.
        """
        low, high = (sp.sympify(end) for end in self.length)
        length = sp.sqrt(self.actuator.square(q))
        clearance = (length - low) * (high - length) + sp.Float(1e-3) * (high - low) ** 2
        return clearance, self.rev * sp.sin(self.actuator.angle(q))

    def motor_guards(self, q_m: sp.Expr) -> tuple[sp.Expr, ...]:
        """Sixteen times the squared area of the triangle [m^4]."""
        l1, l2 = sp.sympify(self.l1), sp.sympify(self.l2)
        return (4 * l1**2 * l2**2 - (l1**2 + l2**2 - self._length(q_m) ** 2) ** 2,)

    def stroke(self) -> Range:
        """The ends of `motor`."""
        return min(self.motor), max(self.motor)

    def reach(self) -> Range:
        """Reach between the ends of the stroke, which must make triangles off the dead centres."""
        l1, l2, low, high, first, last, rev, offset = self.numbers()
        if low == high:
            raise FigureError(f"both lengths are {low:g} m, expected a stroke", "length")
        if first == last:
            raise FigureError(f"both motor values are {first:g}, expected a range", "motor")
        for i, length in enumerate((low, high)):
            _check_triangle(l1, l2, length, i)
        ends = sorted(rev * inner_angle(l1, l2, length) + offset for length in (low, high))
        return ends[0], ends[1]

    @classmethod
    def refusal(cls, joint_type: str) -> str:
        """Why a slide refuses a lever, and what to take instead."""
        if joint_type == cls.joint_type:
            return ""
        return (
            f"found a levered drive on a {joint_type} joint; a lever turns a revolute joint, "
            "a ball-screw axis is direct with ratio 2*pi/lead"
        )


def _check_triangle(l1: float, l2: float, length: float, end: int) -> None:
    low, high = abs(l1 - l2), l1 + l2
    if not low <= length <= high:
        raise FigureError(
            f"found the actuator length {length:g} m, an impossible triangle: with l1 = {l1:g} m and "
            f"l2 = {l2:g} m it must lie between |l1 - l2| = {low:g} m and l1 + l2 = {high:g} m",
            "length",
            end,
        )
    angle = inner_angle(l1, l2, length)
    if not DEAD_CENTRE_MARGIN <= angle <= math.pi - DEAD_CENTRE_MARGIN:
        centre = "0" if angle < 1.0 else "180"
        raise FigureError(
            f"at the length {length:g} m the stroke reaches the lever's dead centre: inner angle "
            f"{math.degrees(angle):.3g} deg, expected at least {math.degrees(DEAD_CENTRE_MARGIN):g} deg "
            f"from {centre} deg",
            "length",
            end,
        )
