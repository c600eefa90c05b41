"""Friction over speed alone."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

import sympy as sp

from modelgen.description.objects import Arm
from modelgen.effects.base import ANY, POSITIVE, Effect, Parameter, Values, at
from modelgen.effects.traits import Family, Numbers, Reading, Seen, Shows
from modelgen.effects.variables import Variables

SMOOTHING = Parameter(
    "smoothing",
    "{x}/s",
    "velocity over which the sign is smoothed by tanh; 0 keeps the sign",
    default=0.0,
    structural=True,
)
AT_REST = 1.0  # s, over which a current is read
STILL = 1e-12  # of the speed that a power refers to: far below what any drive does or any encoder reads
NEAR_REST = 1.05  # times the least exponent that is searched: a power below it is dry friction


def direction(velocity: sp.Expr, smoothing: sp.Expr) -> sp.Expr:
    """sign(velocity), smoothed by tanh where `smoothing` is positive; sign(0) = 0."""
    return sp.sign(velocity) if smoothing == 0 else sp.tanh(velocity / smoothing)


def powered(ratio: sp.Expr, exponent: sp.Expr | float) -> sp.Expr:
    """|ratio|^exponent, for an exponent below one rounded within STILL of zero, where its slope has no bound.

    Derivatives of a law are finite at rest then, in every backend.
    """
    if exponent == 2:
        return ratio**2
    if sp.sympify(exponent).is_number and exponent < 1:
        return (ratio**2 + STILL**2) ** (exponent / 2)
    return sp.Abs(ratio) ** exponent


class Friction(Effect):
    """A law of friction over the joint's own motion, of a form that is that of no joint to the last."""

    family = Family.FRICTION


class ViscousFriction(Effect):
    """Friction in proportion to speed."""

    name = "viscous_friction"
    text = "friction in proportion to speed"
    finding = "friction in {drive} grows with the speed"
    reference = "Armstrong-Helouvry, Dupont and Canudas de Wit 1994"
    linear = (Parameter("coefficient", "{f} s/{x}", "viscous friction coefficient", "FV"),)
    confused_with = ("nonlinear_viscous_friction", "fluid_drag")
    experiment = "a sweep of constant speeds"
    shown = at(coefficient=0.001)
    sources = MappingProxyType({"damping": "coefficient"})

    def law(self, x: Variables, p: Values) -> sp.Expr:
        """FV v."""
        return p["coefficient"] * x.velocity


class CoulombFriction(Effect):
    """Dry friction of constant magnitude."""

    name = "coulomb_friction"
    text = "dry friction of constant magnitude against the motion"
    finding = "there is dry friction in {drive}"
    reference = "Armstrong-Helouvry, Dupont and Canudas de Wit 1994"
    linear = (Parameter("magnitude", "{f}", "Coulomb friction", "FC"),)
    confused_with = ("friction_offset", "presliding", "backlash")
    experiment = "slow reversals"
    shown = at(magnitude=0.1)
    sources = MappingProxyType({"friction": "magnitude"})
    nonlinear = (SMOOTHING,)

    @classmethod
    def hidden(cls, arm: Arm, seen: Seen, named: bool) -> list[str]:
        """A joint at rest hides it."""
        return [f"{arm.coordinate_names[n - 1]} does not move in the training records" for n in seen.still]

    def law(self, x: Variables, p: Values) -> sp.Expr:
        """FC sign(v)."""
        return p["magnitude"] * direction(x.velocity, p["smoothing"])


class FrictionOffset(Effect):
    """A constant force: asymmetric Coulomb friction, or the offset of a current sensor."""

    name = "friction_offset"
    seen_over = "position"
    text = "constant force while moving: asymmetric Coulomb friction or an offset of the current"
    finding = "a constant force acts in {drive} while it moves"
    needs_drive = True  # a bearing alone is alike in both directions
    reference = "Khalil and Dombre 2002"
    exact = True
    confused_with = ("asymmetric_viscous_friction", "spring", "base_tilt")
    reading = Reading(
        f"the current at rest with the motor switched off, for {AT_REST:g} s",
        ("offset",),
        duration=AT_REST,
        claim="an offset of the sensor of {}; none with asymmetric friction",
    )
    experiment = "the current with the motor switched off, and constant speeds in both directions"
    shown = at(offset=0.05)
    laws = MappingProxyType({"force": "offset"})
    linear = (Parameter("offset", "{f}", "constant force", "FO", bounds=ANY),)

    @classmethod
    def simulated(cls, values: Numbers) -> Mapping[str, float]:
        """A constant force."""
        return {"force": values["offset"]}

    def law(self, x: Variables, p: Values) -> sp.Expr:
        """FO."""
        return p["offset"]

    def potential(self, x: Variables, p: Values) -> sp.Expr:
        """FO x: a constant force is conservative, and cannot be distinguished from a spring's preload."""
        return p["offset"] * x.position


class AsymmetricViscousFriction(Effect):
    """Viscous friction that differs between the directions."""

    name = "asymmetric_viscous_friction"
    text = "viscous friction of different size in the two directions"
    finding = "viscous friction in {drive} differs between the two directions"
    reference = "Elhami and Brookfield 1996"
    varies = (ViscousFriction,)
    linear = (
        Parameter(
            "coefficient",
            "{f} s/{x}",
            "half the difference of both directions'",
            "FA",
            bounds=ANY,
        ),
    )
    confused_with = ("friction_offset",)
    experiment = "constant speeds, several in each direction"
    shown = at(coefficient=0.0005)

    def law(self, x: Variables, p: Values) -> sp.Expr:
        """FA |v|."""
        return p["coefficient"] * sp.Abs(x.velocity)


class NonlinearViscousFriction(Friction):
    """Viscous friction that is not in proportion to speed."""

    name = "nonlinear_viscous_friction"
    text = "friction in proportion to a power of the speed, besides the viscous one"
    finding = "friction in {drive} does not grow in proportion to the speed"
    reference = "Grotjahn, Daemi and Heimann 2001; Wolf and Iskandar 2018"
    varies = (ViscousFriction,)
    linear = (Parameter("coefficient", "{f}", "friction at the speed of its scale", "FN", bounds=ANY),)
    nonlinear = (
        Parameter(
            "exponent",
            "1",
            "power of the speed",
            default=2.0,
            bounds=(0.1, 4.0),
            grid=(0.3, 0.6, 1.6, 2.0, 3.0),
        ),
        Parameter(
            "scale",
            "{x}/s",
            "speed to which the power is referred",
            default=1.0,
            bounds=POSITIVE,
            scale="speed",
            grid=(1.0,),
        ),
    )
    confused_with = ("stribeck_friction", "fluid_drag", "torque_constant_saturation")
    experiment = "constant speeds up to the highest"
    shown = at(coefficient=0.1, exponent=0.6, scale=100.0)

    @classmethod
    def imitates(cls, values: Numbers) -> Shows | None:
        """The least power is dry friction that is lower near rest."""
        least = cls.nonlinear[0].grid[0]
        return Shows.NEAR_REST if values.get("exponent", math.inf) < NEAR_REST * least else None

    @classmethod
    def simulated(cls, values: Numbers) -> Mapping[str, float]:
        """A term of a polynomial where the power is whole."""
        exponent = values["exponent"]
        word = {1.0: "damping", 2.0: "quadratic", 3.0: "cubic"}.get(exponent)
        return {} if word is None else {word: values["coefficient"] / values["scale"] ** exponent}

    @classmethod
    def recognised(cls, properties: Numbers) -> Mapping[str, float]:
        """The second or third term of a polynomial."""
        for word, exponent in (("quadratic", 2.0), ("cubic", 3.0)):
            if set(properties) == {word}:
                return {"coefficient": properties[word], "exponent": exponent, "scale": 1.0}
        return {}

    def law(self, x: Variables, p: Values) -> sp.Expr:
        """FN |v / scale|^exponent sign(v)."""
        ratio = x.velocity / p["scale"]
        if p["exponent"] == 2:
            return p["coefficient"] * sp.Abs(ratio) * ratio
        return p["coefficient"] * powered(ratio, p["exponent"]) * sp.sign(x.velocity)
