"""Friction laws without states."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from modelgen.effects.base import Effect, Parameter, Variables

SMOOTHING = Parameter(
    "smoothing",
    "{x}/s",
    "velocity over which the sign is smoothed by tanh; 0 keeps the sign",
    default=0.0,
    bounds=(0.0, float("inf")),
)


def direction(velocity: sp.Expr, smoothing: sp.Expr) -> sp.Expr:
    """sign(velocity), smoothed by tanh where `smoothing` is positive; sign(0) = 0."""
    return sp.sign(velocity) if smoothing == 0 else sp.tanh(velocity / smoothing)


class ViscousFriction(Effect):
    """Friction in proportion to speed."""

    name = "viscous_friction"
    text = "friction in proportion to speed"
    reference = "Armstrong-Helouvry, Dupont and Canudas de Wit 1994"
    linear = (Parameter("coefficient", "{f} s/{x}", "viscous friction coefficient", "FV"),)

    def law(self, x: Variables, p: Mapping[str, sp.Expr]) -> sp.Expr:
        """FV v."""
        return p["coefficient"] * x.velocity


class CoulombFriction(Effect):
    """Dry friction of constant magnitude."""

    name = "coulomb_friction"
    text = "dry friction of constant magnitude against the motion"
    reference = "Armstrong-Helouvry, Dupont and Canudas de Wit 1994"
    linear = (Parameter("magnitude", "{f}", "Coulomb friction", "FC"),)
    nonlinear = (SMOOTHING,)

    def law(self, x: Variables, p: Mapping[str, sp.Expr]) -> sp.Expr:
        """FC sign(v)."""
        return p["magnitude"] * direction(x.velocity, p["smoothing"])


class FrictionOffset(Effect):
    """A constant force: asymmetric Coulomb friction, or the offset of a current sensor."""

    name = "friction_offset"
    text = "constant force while moving: asymmetric Coulomb friction or an offset of the current"
    reference = "Khalil and Dombre 2002"
    linear = (Parameter("offset", "{f}", "constant force", "FO", bounds=(-float("inf"), float("inf"))),)

    def law(self, x: Variables, p: Mapping[str, sp.Expr]) -> sp.Expr:
        """FO."""
        return p["offset"]

    def potential(self, x: Variables, p: Mapping[str, sp.Expr]) -> sp.Expr:
        """FO x: a constant force is conservative, and cannot be told from a spring's preload."""
        return p["offset"] * x.position


class StribeckFriction(Effect):
    """Dry friction that falls from its value near rest to the Coulomb level."""

    name = "stribeck_friction"
    text = "dry friction in excess of Coulomb's at low speed"
    reference = "Stribeck 1902; Bo and Pavelescu 1982"
    linear = (Parameter("magnitude", "{f}", "excess of static over Coulomb friction", "FS"),)
    nonlinear = (
        Parameter("velocity", "{x}/s", "Stribeck velocity", bounds=(1e-12, float("inf"))),
        Parameter("exponent", "1", "shape of the fall", default=2.0, bounds=(0.5, 4.0)),
        SMOOTHING,
    )

    def law(self, x: Variables, p: Mapping[str, sp.Expr]) -> sp.Expr:
        """FS exp(-|v / v_s|^exponent) sign(v)."""
        ratio = x.velocity / p["velocity"]
        power = ratio**2 if p["exponent"] == 2 else sp.Abs(ratio) ** p["exponent"]
        return p["magnitude"] * sp.exp(-power) * direction(x.velocity, p["smoothing"])
