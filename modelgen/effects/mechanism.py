"""Inertia of the drive and stiffness at the joint."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from modelgen.effects.base import Effect, Parameter, Variables


class DriveInertia(Effect):
    """Inertia of everything that moves in proportion to the motor coordinate.

    Rotor, gears, the turning and the travelling parts of a screw: all merge in one coefficient.
    """

    name = "drive_inertia"
    text = "inertia of motor, gears and screw, at the motor coordinate"
    reference = "Leborne, Creuze, Chemori and Brignone 2018, (16)"
    linear = (Parameter("inertia", "{f} s^2/{x}", "inertia of the drive", "IA"),)

    def law(self, x: Variables, p: Mapping[str, sp.Expr]) -> sp.Expr:
        """IA a."""
        return p["inertia"] * x.acceleration


class Spring(Effect):
    """A passive spring at the joint: a gravity compensator, a hose, a cable."""

    name = "spring"
    text = "passive spring at the joint, with its angle or place of rest"
    reference = "Klimchik, Caro, Furet and Pashkevich 2013"
    side = "joint"
    linear = (
        Parameter("stiffness", "{f}/{x}", "stiffness", "KS"),
        Parameter(
            "preload",
            "{f}",
            "force at q = 0, that is -stiffness times rest",
            "KO",
            bounds=(-float("inf"), float("inf")),
        ),
    )
    rest = Parameter("rest", "{x}", "coordinate at rest", bounds=(-float("inf"), float("inf")))

    def law(self, x: Variables, p: Mapping[str, sp.Expr]) -> sp.Expr:
        """KS q + KO."""
        return p["stiffness"] * x.position + p["preload"]

    def potential(self, x: Variables, p: Mapping[str, sp.Expr]) -> sp.Expr:
        """KS q^2 / 2 + KO q."""
        return p["stiffness"] * x.position**2 / 2 + p["preload"] * x.position

    def values(self, given: Mapping[str, float]) -> dict[str, float]:
        """A rest coordinate in the description stands for the preload."""
        values = super().values(given)
        if "rest" in given:
            values["preload"] = -given["rest"] * given.get("stiffness", 0.0)
        return values

    @classmethod
    def accepted(cls) -> tuple[Parameter, ...]:
        """Also `rest`."""
        return (*super().accepted(), cls.rest)
