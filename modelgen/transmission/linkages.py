"""Drives through a linkage; to add a drive, add a class here."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import sympy as sp

from modelgen.symbolic import Range, Scalar
from modelgen.transmission.bars import AXIS, Bar, Point
from modelgen.transmission.drive import NO_LIMITS, Drive, MotorLimits
from modelgen.transmission.figures import Figure

DEAD_CENTRE = math.radians(5.0)  # nearer to a dead centre, gain or speed ratio is next to nothing


@dataclass(frozen=True)
class SliderCrank(Drive):
    """A screw moves a nut along a straight line, and a rod from the nut turns the joint's lever.

    a = q - offset is the lever's angle from the direction of the screw. From the joint's axis, the pin is at
    (lever cos a, lever sin a) and the nut at (x, height), x > 0; they are the rod's length apart:
    (x - lever cos a)^2 + (height - lever sin a)^2 = rod^2 (Norton, Design of Machinery, 2012, chapter 4).
    """

    name = "slider_crank"
    text = "a screw whose nut turns the joint by a rod and a lever; q_m = 2 pi x / lead"
    joint_type = "revolute"
    origin = "offset"

    lever: Annotated[Scalar, Figure("length", "Distance from the joint axis to the pin of the rod [m].")]
    rod: Annotated[Scalar, Figure("length", "Distance between the pins of the rod [m].")]
    height: Annotated[
        Scalar, Figure("length", "Distance from the joint axis to the line of the nut's pin [m].")
    ]
    lead: Annotated[Scalar, Figure("length", "Travel of the nut per turn of the motor [m].")]
    offset: Annotated[
        Scalar, Figure("angle", "Joint angle at which the lever points along the screw, to the nut [rad].")
    ]
    torque_constant: float
    limits: MotorLimits = NO_LIMITS

    def nut(self, q: sp.Expr) -> sp.Expr:
        """Place of the nut along the screw [m]: x = lever cos a + sqrt(rod^2 - (height - lever sin a)^2)."""
        a = q - self.offset
        across = self.height - self.lever * sp.sin(a)
        return self.lever * sp.cos(a) + sp.sqrt(self.rod**2 - across**2)

    def motor_from_joint(self, q: sp.Expr) -> sp.Expr:
        """2 pi x / lead."""
        return 2 * sp.pi / self.lead * self.nut(q)

    def linkage(self, q: sp.Expr) -> tuple[Bar, ...]:
        """Lever, rod, and the screw between the nut's ends."""
        a = q - self.offset
        height = sp.sympify(self.height)
        pin: Point = (self.lever * sp.cos(a), self.lever * sp.sin(a))
        near, far = (self.nut(sp.Float(end)) for end in self.reach()[::-1])
        return (
            Bar("lever", "own", AXIS, pin),
            Bar("rod", "between", pin, (self.nut(q), height)),
            Bar("screw", "before", (near, height), (far, height)),
        )

    def joint_from_motor(self, q_m: sp.Expr) -> sp.Expr:
        """The law of cosines in the triangle of axis, pin and nut."""
        x = self.lead * q_m / (2 * sp.pi)
        direction = self.height / x
        distance = x * sp.sqrt(1 + direction**2)  # x is positive on the reach
        cosine = (self.lever**2 + distance**2 - self.rod**2) / (2 * self.lever * distance)
        return self.offset + sp.atan(direction) + sp.acos(cosine)

    def reach(self) -> Range:
        """Between the lever pointing to the nut, and away from it."""
        lever, rod, height, lead, offset = self.numbers()
        if min(lever, rod) <= 0 or lead == 0:
            raise ValueError("expected lever and rod above 0 and a lead other than 0")
        if rod <= lever + abs(height):
            raise ValueError(
                f"the rod is {rod:g} m, expected longer than lever + |height| = {lever + abs(height):g} m"
            )
        far = math.asin(height / (rod + lever))
        near = math.pi + math.asin(height / (rod - lever))
        return offset + far + DEAD_CENTRE, offset + near - DEAD_CENTRE
