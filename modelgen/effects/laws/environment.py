"""The arm's surroundings: fluid, payload, the ground that it stands on."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import sympy as sp

from modelgen.description.objects import Arm, Joint
from modelgen.effects.base import ANY, DescriptionEffect, LinkEffect, Parameter, Point, Values, at
from modelgen.effects.traits import Added, Family, Numbers, Presence, Reading, Seen, visible
from modelgen.effects.variables import PointVariables
from modelgen.numeric import Array
from modelgen.symbolic import number as value_of

# Gauss-Legendre quadrature with five points on [0, 1]: (place, weight)
_NODES = tuple(
    ((1 + side * root) / 2, weight / 2)
    for side, root, weight in (
        (-1, 0.9061798459386640, 0.2369268850561891),
        (-1, 0.5384693101056831, 0.4786286704993665),
        (1, 0.0, 0.5688888888888889),
        (1, 0.5384693101056831, 0.4786286704993665),
        (1, 0.9061798459386640, 0.2369268850561891),
    )
)
PLACE = 1e-3  # m, step of the slopes by a payload's place
STILL = 1e-12  # [m^2/s^2] added under the root of a speed squared, so that its slope exists at rest
TIP = tuple(
    Parameter(
        f"tip_{axis}",
        "m",
        f"{axis} of the end of a link that carries no other",
        default=0.0,
        bounds=ANY,
        structural=True,
    )
    for axis in "xyz"
)


class Strips(LinkEffect):
    """Forces along the line of a link, by quadrature."""

    nonlinear = TIP
    family = Family.FLUID
    own_sizes = True

    @classmethod
    def stands_at(cls, arm: Arm, number: int | None) -> bool:
        """It stands where links that carry no other have nominal inertials, from which their end follows."""
        return not _endless(arm)

    @classmethod
    def hidden(cls, arm: Arm, seen: Seen, named: bool) -> list[str]:
        """It was not looked for where nobody knows where the arm ends."""
        there = named or any(use.name == cls.name for use in arm.effects)
        ends = "" if there else ", ".join(_endless(arm))
        text = f"it is not looked for where links that carry no other have no nominal inertials: {ends}"
        return [text] if ends else []

    @classmethod
    def judged_at(cls, joint: int | None, fixed: Numbers, n: int) -> list[int]:
        """By all joints that may carry the link: a slow one far out is held by those that swing it."""
        return list(range(n if joint is None else joint))

    def points(self, p: Values) -> Sequence[Point]:
        """The nodes of the quadrature."""
        return [Point(fraction=place, part=weight) for place, weight in _NODES]


def _ends(arm: Arm) -> list[tuple[str, bool]]:
    """Links that carry no other, by the names of their joints, and whether they have nominal inertials."""
    carrying = {joint.antecedent for joint in arm.joints}
    return [
        (joint.name, link is not None)
        for i, (joint, link) in enumerate(zip(arm.joints, arm.links, strict=True))
        if i not in carrying
    ]


def _endless(arm: Arm) -> list[str]:
    """Links that carry no other and have no nominal inertials, by the names of their joints."""
    return [name for name, known in _ends(arm) if not known]


def _guessed_end(arm: Arm) -> float:
    """Length [m] of the longest link, where no end is known; 0 where some are, or no link has a length."""
    if any(known for _, known in _ends(arm)):
        return 0.0
    return max((_away(arm, j) for j in arm.joints if j.antecedent is not None), default=0.0)


def _away(arm: Arm, joint: Joint) -> float:
    """Distance [m] of a joint's frame from its antecedent's."""
    return math.hypot(*(value_of(x, arm.symbols) for x in (joint.d, joint.r, joint.b)))


class FluidDrag(Strips):
    """Drag of slender links, strip by strip, quadratic in the speed across the link."""

    name = "fluid_drag"
    text = "drag of the fluid on slender links, quadratic in the speed across them"
    finding = "a fluid drags on {place}"
    reference = "Morison, Johnson and Schaaf 1950; Levesque and Richard 1994"
    linear = (
        Parameter("coefficient", "N s^2/m^3", "half density, drag coefficient and width together", "CD"),
    )
    confused_with = ("nonlinear_viscous_friction", "added_mass")
    experiment = "the same motion in air and in the fluid, the arm folded and straight"
    shown = at(coefficient=60.0)

    @classmethod
    def stands_at(cls, arm: Arm, number: int | None) -> bool:
        """It stands where the end of links that carry no other is known; on the whole arm where it can be
        guessed too: which link drags is asked of no guess.
        """
        return super().stands_at(arm, number) or (number is None and _guessed_end(arm) > 0.0)

    @classmethod
    def variants(cls, arm: Arm, number: int | None) -> list[dict[str, float]]:
        """An end that nobody knows is as far away as the longest link's, across the joint's axis."""
        away = _guessed_end(arm)
        if not away:
            return super().variants(arm, number)
        unknown = {f"tip_{axis}": 0.0 for axis in "xyz"}
        return [unknown | {f"tip_{axis}": side * away} for axis in "xy" for side in (1.0, -1.0)]

    @classmethod
    def conditional(cls, fixed: Numbers) -> tuple[str, ...]:
        """What is estimated by length of a link that is a guess."""
        return cls.estimated() if "tip_x" in fixed else ()

    @classmethod
    def hidden(cls, arm: Arm, seen: Seen, named: bool) -> list[str]:
        """What is said of it where nobody knows where the arm ends."""
        away, ends = _guessed_end(arm), ", ".join(_endless(arm))
        if not away or any(use.name == cls.name for use in arm.effects):
            return super().hidden(arm, seen, named)
        known = f"nominal inertials, or tip_x, tip_y and tip_z, say where {ends} ends"
        if named:
            return [f"its size is that of a link whose end is a guess: {known}"]
        return [f"it is looked for as if the end were {away:.3g} m from the joint: {known}"]

    def force(self, x: PointVariables, p: Values) -> sp.Matrix:
        """CD |v| v by length, v the velocity across the link."""
        v = x.across(x.velocity)
        return p["coefficient"] * x.length * sp.sqrt(v.dot(v) + STILL) * v


class AddedMass(Strips):
    """Fluid that moves with a slender link across it, and lets it slip along itself."""

    name = "added_mass"
    seen_over = "acceleration"
    text = "fluid that slender links accelerate with them, across their line"
    finding = "fluid is accelerated along with {place}"
    reference = "Kirchhoff 1870; Fossen 2011"
    linear = (Parameter("per_length", "kg/m", "mass of the fluid by length of the link", "CM"),)
    confused_with = ("payload_change", "fluid_drag")
    experiment = "the same motion in air and in the fluid, fast and slow"
    shown = at(per_length=4.0)

    def force(self, x: PointVariables, p: Values) -> sp.Matrix:
        """What changes the energy CM v.v / 2 by length, v the velocity across the link; a moment besides.

        It is the momentum's derivative: CM (a - (u.v) du/dt - u (v.du/dt)) by length, a the acceleration
        across the link, u its direction; each product of two rates as the mean of those with either of the
        two motions, so that dM/dt - 2 C stays skew-symmetric.
        """
        turn = (x.turn * x.along(x.reference) + x.reference_turn * x.along(x.velocity)) / 2
        slip = x.line * (x.turn.dot(x.reference) + x.reference_turn.dot(x.velocity)) / 2
        return p["per_length"] * x.length * (x.across(x.acceleration + x.gravity) - turn - slip)

    def moment(self, x: PointVariables, p: Values) -> sp.Matrix:
        """Munk's, CM (u.v) u x v by length: it turns a slender link across its way."""
        slip = (x.reference * x.along(x.velocity) + x.velocity * x.along(x.reference)) / 2
        return p["per_length"] * x.length * x.line.cross(slip)


class PayloadChange(LinkEffect):
    """A mass that is there in some records only, as a point on the last link."""

    name = "payload_change"
    seen_over = "position"
    text = "a payload besides the one that the parameters hold, as a point mass on the link"
    finding = "the load carried by {place} has changed by {mass}"
    reference = "Khalil, Gautier and Lemoine 2007"
    nonlinear = (
        Parameter("mass", "kg", "mass of the payload", bounds=ANY),
        Parameter("x", "m", "its place in the link's frame", default=0.0, bounds=ANY),
        Parameter("y", "m", "its place in the link's frame", default=0.0, bounds=ANY),
        Parameter("z", "m", "its place in the link's frame", default=0.0, bounds=ANY),
    )
    parts = (("mass", "moment_x"),)  # held along the last link
    exact = True
    presence = Presence.SOME
    claims = ("mass",)
    confused_with = ("friction_warm_up", "base_tilt")
    reading = Reading("what the last link carries on a balance, to 10 g", ("mass",), 0.01)
    experiment = "weigh it, or compare records with and without"
    shown = at(mass=1.0, x=0.5)

    @classmethod
    def estimated(cls) -> tuple[str, ...]:
        """Mass and first moments, of which its force is a sum."""
        return "mass", "moment_x", "moment_y", "moment_z"

    @classmethod
    def impossible(cls, arm: Arm, number: int | None, values: Numbers) -> str:
        """The arm carries it: it is no farther from the last joint than the arm could reach."""
        away, most = math.hypot(*(values.get(a, 0.0) for a in "xyz")), _reach(arm)
        if not most or away <= most:
            return ""
        return f"a payload {away:.2g} m from the last joint is beyond the reach of an arm of {most / 2:.2g} m"

    @classmethod
    def slopes(cls, names: Sequence[str], values: Numbers, added: Added) -> Array:
        """Changes of the inputs with mass and first moments of what the last link carries.

        values: mass and place of what was found; its second moments are as if it were all there. At the
        link's origin where there is none.
        """
        place = {a: values.get(a, 0.0) if values.get("mass", 0.0) > 0 else 0.0 for a in "xyz"}

        def of(**moved: float) -> Array:
            return added({"mass": 1.0, **place, **moved})

        moments = []
        for a in "xyz":
            ahead, behind = (of(**{a: place[a] + d}) for d in (PLACE, -PLACE))
            moments.append((ahead - behind) / (2 * PLACE))
        mass = of() - sum(place[a] * moment for a, moment in zip("xyz", moments, strict=True))
        columns = dict(zip(cls.estimated(), (mass, *moments), strict=True))
        return visible(np.stack([columns[name] for name in names], axis=2))

    @classmethod
    def hidden(cls, arm: Arm, seen: Seen, named: bool) -> list[str]:
        """One that is always there."""
        text = "a payload that is there in all training records is a part of the last link's parameters"
        return [] if named else [text]

    @classmethod
    def physical(cls, found: Numbers) -> dict[str, float]:
        """Its place from the first moments."""
        mass = found.get("mass")
        if not mass:
            return dict(found)
        return {"mass": mass, **{a: found.get(f"moment_{a}", 0.0) / mass for a in "xyz"}}

    def links(self, arm: Arm, joint: int | None) -> list[int]:
        """The joint's own, the last one for the whole arm."""
        return [len(arm.joints) - 1 if joint is None else joint]

    def points(self, p: Values) -> Sequence[Point]:
        """Its place."""
        return [Point((p["x"], p["y"], p["z"]))]

    def masses(self, p: Values) -> Sequence[tuple[sp.Expr, Sequence[sp.Expr]]]:
        """It."""
        return [(p["mass"], (p["x"], p["y"], p["z"]))]

    def force(self, x: PointVariables, p: Values) -> sp.Matrix:
        """mass times acceleration less gravity."""
        return p["mass"] * x.acceleration


def _reach(arm: Arm) -> float:
    """Distance from the last joint within which a payload may be [m]: twice the arm's length up to there, for
    a description ends at the last joint; any where that is 0.
    """
    return 2.0 * sum(_away(arm, joint) for joint in arm.joints)


def _turn(axis: str) -> Parameter:
    """One of the base's."""
    text, bounds = f"turn about {axis} of the base", (-math.pi, math.pi)
    return Parameter(axis, "rad", text, default=0.0, bounds=bounds, step=1e-4, usual=0.03)


class BaseTilt(DescriptionEffect):
    """The base stands at an angle to where the description has it."""

    name = "base_tilt"
    seen_over = "position"
    text = "base turned about its x, then its y axis, against the described direction of gravity"
    finding = "the base is tilted against the described gravity"
    reference = "Ayusawa, Venture and Nakamura 2014"
    scope = "arm"
    nonlinear = (_turn("x"), _turn("y"), _turn("z"))
    overlooked = (10.0, 0.0)
    confused_with = ("encoder_offset", "friction_offset", "spring")
    reading = Reading("the base with an inclinometer, to 0.1 deg", ("x", "y", "z"), 1.7e-3)
    experiment = "an inclinometer, or a second mounting of the base"
    shown = at(z=0.05)

    @classmethod
    def subsets(cls, arm: Arm, number: int | None) -> tuple[tuple[str, ...], ...]:
        """Two turns, without that about the axis next to gravity: gravity leans in two directions."""
        along = max(range(3), key=lambda axis: abs(float(arm.gravity[axis])))
        return (tuple(name for axis, name in enumerate("xyz") if axis != along),)

    def changed(self, arm: Arm, joint: int | None, values: Mapping[str, float]) -> Arm:
        """Gravity as the turned base sees it: Rz' Ry' Rx' g."""
        g = sp.Matrix(arm.gravity)
        for axis, name in enumerate("xyz"):
            g = _rotation(axis, -values[name]) * g
        return replace(arm, gravity=(float(g[0]), float(g[1]), float(g[2])))


def _rotation(axis: int, angle: float) -> sp.Matrix:
    c, s = math.cos(angle), math.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = sp.eye(3)
    matrix[i, i] = matrix[j, j] = c
    matrix[i, j], matrix[j, i] = -s, s
    return matrix
