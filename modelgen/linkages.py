"""Drives through a linkage: each is one class, the motor coordinate as a function of the joint's.

What `drive: {type: ...}` accepts, the JSON Schema, velocities and accelerations by differentiation, the gain
by virtual work, the range in which the generated code works: all follow from the class. To add a drive,
add a class here, below the others.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import sympy as sp

Values = Mapping[str, sp.Expr]  # figures by name
DEAD_CENTRE = math.radians(5.0)  # nearer to a dead centre, gain or speed ratio is next to nothing


@dataclass(frozen=True)
class Figure:
    """A figure that the description gives. kind: "length" [m], "angle" [rad] or "plain" (as it stands)."""

    name: str
    kind: str
    text: str


class Linkage(ABC):
    """A drive: `name` is its type in the description, `unit` that of the motor coordinate.

    joint: the type of joint it can drive, "revolute" or "prismatic".
    """

    name: ClassVar[str]
    text: ClassVar[str]
    unit: ClassVar[str] = "rad"
    joint: ClassVar[str] = "revolute"
    figures: ClassVar[tuple[Figure, ...]]

    @abstractmethod
    def motor(self, q: sp.Symbol, p: Values) -> sp.Expr:
        """The motor coordinate at q, for the figures `p`."""

    @abstractmethod
    def inverse(self, q_m: sp.Symbol, p: Values) -> sp.Expr:
        """q at the motor coordinate: the inverse of `motor` on the reach."""

    @abstractmethod
    def reach(self, p: Mapping[str, float]) -> tuple[float, float]:
        """Lowest and highest q [rad or m], within the dead centres. ValueError where there are none."""


class SliderCrank(Linkage):
    """A screw moves a nut along a straight line, and a rod from the nut turns the joint's lever.

    a = q - offset is the lever's angle from the direction of the screw. From the joint's axis, the pin is at
    (lever cos a, lever sin a) and the nut at (x, height), x > 0; they are the rod's length apart:
    (x - lever cos a)^2 + (height - lever sin a)^2 = rod^2 (Norton, Design of Machinery, 2012, chapter 4).
    """

    name = "slider_crank"
    text = "a screw whose nut turns the joint by a rod and a lever; q_m = 2 pi x / lead"
    figures = (
        Figure("lever", "length", "Distance from the joint axis to the pin of the rod [m]."),
        Figure("rod", "length", "Distance between the pins of the rod [m]."),
        Figure("height", "length", "Distance from the joint axis to the line of the nut's pin [m]."),
        Figure("lead", "length", "Travel of the nut per turn of the motor [m]."),
        Figure("offset", "angle", "Joint angle at which the lever points along the screw, to the nut [rad]."),
    )

    def motor(self, q: sp.Symbol, p: Values) -> sp.Expr:
        """2 pi x / lead with x = lever cos a + sqrt(rod^2 - (height - lever sin a)^2)."""
        a = q - p["offset"]
        across = p["height"] - p["lever"] * sp.sin(a)
        return 2 * sp.pi / p["lead"] * (p["lever"] * sp.cos(a) + sp.sqrt(p["rod"] ** 2 - across**2))

    def inverse(self, q_m: sp.Symbol, p: Values) -> sp.Expr:
        """The law of cosines in the triangle of axis, pin and nut."""
        x = p["lead"] * q_m / (2 * sp.pi)
        direction = p["height"] / x
        distance = x * sp.sqrt(1 + direction**2)  # x is positive on the reach
        cosine = (p["lever"] ** 2 + distance**2 - p["rod"] ** 2) / (2 * p["lever"] * distance)
        return p["offset"] + sp.atan(direction) + sp.acos(cosine)

    def reach(self, p: Mapping[str, float]) -> tuple[float, float]:
        """Between the lever pointing to the nut, and away from it."""
        lever, rod, height = p["lever"], p["rod"], p["height"]
        if min(lever, rod) <= 0 or p["lead"] == 0:
            raise ValueError("expected lever and rod above 0 and a lead other than 0")
        if rod <= lever + abs(height):
            raise ValueError(
                f"the rod is {rod:g} m, expected longer than lever + |height| = {lever + abs(height):g} m"
            )
        far = math.asin(height / (rod + lever))
        near = math.pi + math.asin(height / (rod - lever))
        return p["offset"] + far + DEAD_CENTRE, p["offset"] + near - DEAD_CENTRE


def collected() -> dict[str, Linkage]:
    """Every class of this module that has a name."""
    classes = [x for x in globals().values() if isinstance(x, type) and "name" in vars(x)]
    return {x.name: x() for x in classes if issubclass(x, Linkage)}


LINKAGES: Mapping[str, Linkage] = collected()
