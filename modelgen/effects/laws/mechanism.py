"""Inertia and stiffness of the mechanism, ripple, and coupling between joints."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
import sympy as sp

from modelgen.description.objects import Arm
from modelgen.effects.base import ANY, POSITIVE, BodyEffect, Effect, Parameter, Swing, Values, at
from modelgen.effects.traits import Family, Numbers, Shows, joint_of
from modelgen.effects.variables import BodyVariables, Variables
from modelgen.symbolic import number as figure
from modelgen.transmission import curves, of_joint

GRAVITY = 0.05  # of a wave in a turn of the joint: nearer, a wave cannot be told from gravity
HEAVY = 0.3  # of the mass of all links, of one actuator


class DriveInertia(Effect):
    """Inertia of all that moves in proportion to the motor coordinate: rotor, gears, the parts of a screw."""

    name = "drive_inertia"
    seen_over = "acceleration"
    text = "inertia of motor, gears and screw, at the motor coordinate"
    finding = "{drive} has an inertia of its own"
    reference = "Leborne, Creuze, Chemori and Brignone 2018, (16)"
    of_rotor = True
    linear = (Parameter("inertia", "{f} s^2/{x}", "inertia of the drive", "IA"),)
    confused_with = ("actuator_mass",)
    experiment = "fast and slow runs of the same path"
    shown = at(inertia=0.0005)
    sources = MappingProxyType({"armature": "inertia"})

    def law(self, x: Variables, p: Values) -> sp.Expr:
        """IA a."""
        return p["inertia"] * x.acceleration


class Spring(Effect):
    """A passive spring at the joint: a gravity compensator, a hose, a cable."""

    name = "spring"
    seen_over = "position"
    text = "passive spring at the joint, with its angle or place of rest"
    finding = "a spring acts at {joint}"
    reference = "Klimchik, Caro, Furet and Pashkevich 2013"
    side = "joint"
    linear = (
        Parameter("stiffness", "{f}/{x}", "stiffness", "KS"),
        Parameter("preload", "{f}", "force at q = 0, that is -stiffness times rest", "KO", bounds=ANY),
    )
    rest = Parameter("rest", "{x}", "coordinate at rest", bounds=ANY)
    family = Family.SPRING
    confused_with = ("friction_offset", "base_tilt", "encoder_offset")
    experiment = "static holds over the whole range"
    shown = at(stiffness=8.0, preload=-4.0)
    sources = MappingProxyType({"stiffness": "stiffness", "rest": "rest"})

    def law(self, x: Variables, p: Values) -> sp.Expr:
        """KS q + KO."""
        return p["stiffness"] * x.position + p["preload"]

    def potential(self, x: Variables, p: Values) -> sp.Expr:
        """KS q^2 / 2 + KO q."""
        return p["stiffness"] * x.position**2 / 2 + p["preload"] * x.position

    @classmethod
    def simulated(cls, values: Numbers) -> Mapping[str, float]:
        """A spring with its place of rest; without stiffness a constant force."""
        stiffness, preload = values["stiffness"], values["preload"]
        if stiffness == 0.0:
            return {"force": preload}
        return {"stiffness": stiffness, "rest": -preload / stiffness}

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


class TorqueRipple(Effect):
    """A force periodic in the motor's angle: cogging, an eccentric screw, a kinematic error."""

    name = "torque_ripple"
    seen_over = "position"
    text = "force that repeats with the motor's angle: cogging, an eccentric screw"
    finding = "a force in {drive} repeats with the motor's angle"
    reference = "Tuttle and Seering 1996; Gandhi, Ghorbel and Dabney 2002"
    linear = (
        Parameter("sine", "{f}", "amplitude of the sine", "RS", bounds=ANY),
        Parameter("cosine", "{f}", "amplitude of the cosine", "RC", bounds=ANY),
    )
    nonlinear = (
        Parameter("harmonic", "1", "waves in a revolution", bounds=POSITIVE),
        Parameter("revolution", "{x}", "a revolution [2 pi rad]", default=2 * math.pi, bounds=POSITIVE),
    )
    periodic = True
    needs_drive = True  # a bearing alone has neither poles nor teeth
    caveat = " Its phase does only where both logs count positions from the same zero."
    shows = frozenset({Shows.BRIEFLY})
    confused_with = ("position_dependent_friction", "lever_geometry")
    experiment = "slow constant speed, and the spectrum over the motor's angle"
    shown = at(sine=0.05, cosine=0.0, harmonic=0.25)
    laws = MappingProxyType({"sine": "sine", "cosine": "cosine", "wave": "harmonic"})

    @classmethod
    def variants(cls, arm: Arm, number: int | None) -> list[dict[str, float]]:
        """A revolution of the motor; where that is not counted in rad, a unit of its coordinate."""
        assert number is not None
        drive = of_joint(arm, joint_of(arm, number))
        turns = (
            drive.unit in ("rad", "unit rad") if drive.driven else joint_of(arm, number).type != "prismatic"
        )
        return [{"revolution": 2 * np.pi if turns else 1.0}]

    @classmethod
    def impossible(cls, arm: Arm, number: int | None, values: Numbers) -> str:
        """One wave in a turn of the joint has the form of gravity."""
        assert number is not None
        joint = joint_of(arm, number)
        low, high = joint.limits.position or (-math.pi, math.pi)
        q = np.array([low, high])
        turns = abs(float(np.diff(curves(of_joint(arm, joint)).motor(q))[0])) / values["revolution"]
        waves = values["harmonic"] * turns / ((high - low) / math.tau)
        if joint.type == "prismatic" or abs(waves - 1.0) > GRAVITY:
            return ""
        return "it has one wave in a turn of the joint, as gravity has"

    @classmethod
    def simulated(cls, values: Numbers) -> Mapping[str, float]:
        """A wave over its coordinate."""
        wave = math.tau * values["harmonic"] / values["revolution"]
        return {"sine": values["sine"], "cosine": values["cosine"], "wave": wave}

    def law(self, x: Variables, p: Values) -> sp.Expr:
        """RS sin(phase) + RC cos(phase), phase = 2 pi harmonic x / revolution."""
        phase = (2 * math.pi) * p["harmonic"] / p["revolution"] * x.position
        return p["sine"] * sp.sin(phase) + p["cosine"] * sp.cos(phase)

    def potential(self, x: Variables, p: Values) -> sp.Expr:
        """Its integral over x: what repeats with the angle stores energy."""
        wave = (2 * math.pi) * p["harmonic"] / p["revolution"]
        phase = wave * x.position
        return (p["cosine"] * sp.sin(phase) - p["sine"] * sp.cos(phase)) / wave


class TransmissionCoupling(Effect):
    """A rotor or gear that turns with two joints: a differential wrist, a belt past an elbow.

    Its coordinate is q + ratio q_other; by virtual work its force acts on both joints.
    """

    name = "transmission_coupling"
    text = "inertia and friction of a part that turns with this joint and with another"
    finding = "a part of the transmission turns with {joint} and {other}"
    reference = "Gautier and Janot 2013; Khalil and Dombre 2002, chapter 9"
    place = "pair"
    linear = (
        Parameter("inertia", "{f} s^2/{x}", "inertia of the coupling", "IC"),
        Parameter("viscous", "{f} s/{x}", "its viscous friction", "FVC"),
        Parameter("dry", "{f}", "its Coulomb friction", "FCC"),
    )
    nonlinear = (
        Parameter(
            "other",
            "1",
            "the other joint; a description has the number of its coordinate",
            bounds=(1.0, 1000.0),
            structural=True,
            joint=True,
        ),
        Parameter(
            "ratio",
            "1",
            "turns per turn of the other joint",
            default=1.0,
            bounds=ANY,
            grid=(-4.0, -1.0, -0.25, 0.25, 1.0, 4.0),
        ),
    )
    confused_with = ("fluid_drag",)
    experiment = "the two joints moved one at a time, then together"
    shown = at(inertia=0.0, viscous=2.0, dry=4.0, other=1.0)
    laws = MappingProxyType(
        {"armature": "inertia", "damping": "viscous", "friction": "dry", "other": "other", "ratio": "ratio"}
    )

    @classmethod
    def stands_at(cls, arm: Arm, number: int | None) -> bool:
        """Beside another joint."""
        return len(arm.coordinates) > 1

    @classmethod
    def variants(cls, arm: Arm, number: int | None) -> list[dict[str, float]]:
        """Couple it with every joint before this one: turn for turn, in either direction, or by any ratio."""
        found = [{"other": float(k)} for k in range(1, number or 1)]
        return [f | r for f in found for r in ({"ratio": 1.0}, {"ratio": -1.0}, {})]

    @classmethod
    def simulated(cls, values: Numbers) -> Mapping[str, float]:
        """Its three terms."""
        return {"armature": values["inertia"], "damping": values["viscous"], "friction": values["dry"]}

    def law(self, x: Variables, p: Values) -> sp.Expr:
        """IC a + FVC v + FCC sign(v) at the coordinate of the coupling."""
        return p["inertia"] * x.acceleration + p["viscous"] * x.velocity + p["dry"] * sp.sign(x.velocity)


class ActuatorMass(BodyEffect):
    """The mass of a linear actuator that swings about its base as it pushes the lever.

    Its base stands on the link before: what the actuator does there as a point is a part of that link's
    parameters. What it does besides, to every joint that moves it, follows from its first moments and from
    its inertia about its base, which a slender body has about both axes across.
    """

    name = "actuator_mass"
    seen_over = "position"
    text = "swing and weight of a linear actuator about its base"
    finding = "the linear actuator of {joint} has a mass that swings with it"
    reference = "Khalil and Dombre 2002, chapter 10; Leborne, Creuze, Chemori and Brignone 2018"
    linear = (
        Parameter("inertia", "kg m^2", "inertia of the actuator about its base", "JS"),
        Parameter("moment_x", "kg m", "its first moment along the actuator", "SX", bounds=ANY),
        Parameter("moment_y", "kg m", "the same across the actuator", "SY", bounds=ANY),
    )
    nonlinear = (
        Parameter(
            "base_angle",
            "rad",
            "direction from the joint to the actuator's base, against x of its frame at q = -theta",
            default=0.0,
            bounds=ANY,
            grid=tuple(k * math.pi / 4 for k in range(1, 9)),
            turns=True,
        ),
    )
    parts = (("inertia", "moment_x"), ("moment_x",))
    overlooked = (10.0, 0.0)
    confused_with = ("lever_geometry", "drive_inertia", "spring")
    experiment = "static holds over the stroke, then fast and slow runs"
    shown = at(inertia=0.05, moment_x=0.3, moment_y=0.1)

    @classmethod
    def stands_at(cls, arm: Arm, number: int | None) -> bool:
        """It stands at a lever."""
        return number is not None and joint_of(arm, number).drive.actuator is not None

    @classmethod
    def pivot_direction(cls, values: Mapping[str, float]) -> float | None:
        """Its base angle."""
        return values.get("base_angle")

    @classmethod
    def variants(cls, arm: Arm, number: int | None) -> list[dict[str, float]]:
        """The place of its base shows only if other joints turn the link that carries it."""
        return [{}] if _carried(arm, number) else [{"base_angle": 0.0}]

    @classmethod
    def subsets(cls, arm: Arm, number: int | None) -> tuple[tuple[str, ...], ...]:
        """The place of its base says also where its weight points."""
        return cls.parts if _carried(arm, number) else super().subsets(arm, number)

    @classmethod
    def usual(cls, arm: Arm, number: int | None) -> Mapping[str, float]:
        """A rod of a part of the links' mass."""
        actuator = None if number is None else joint_of(arm, number).drive.actuator
        mass = HEAVY * sum(link.mass for link in arm.links if link is not None)
        if actuator is None or not mass > 0:
            return {}
        longest = figure(actuator.length[1], arm.symbols)
        moment = mass * longest / 2
        return {"inertia": mass * longest**2 / 3, "moment_x": moment, "moment_y": moment}

    def swing(self, x: BodyVariables, p: Values) -> Swing:
        """It swings from the base, at the distance l1 from the joint, to the lever's end, at l2."""
        q, actuator = x.transmission.q, x.transmission.drive.actuator
        if actuator is None:
            raise ValueError("found on a joint without a lever, expected a levered drive")
        (along, across), turn = actuator.direction(q), actuator.turn(q)
        c, s = sp.cos(p["base_angle"]), sp.sin(p["base_angle"])
        length = sp.sqrt(actuator.square(q))
        cosine, sine = (c * along - s * across) / length, (s * along + c * across) / length
        parts = (cosine, sine, turn, sp.diff(turn, q))
        cosine, sine, turn, bend = (part.subs(q, x.q) for part in parts)
        return Swing(cosine, sine, turn, bend, (actuator.l1 * c, actuator.l1 * s))

    def force(self, x: BodyVariables, p: Values) -> tuple[sp.Matrix, sp.Matrix, sp.Matrix]:
        """SX x'' + SY y'' at the base, SX a + JS x'' and SY a at 1 m on its axes; a that of the base.

        x, y: its axes, along the actuator and across. a: acceleration of the base less gravity.
        """
        sx, sy = p["moment_x"], p["moment_y"]
        return sx * x.along + sy * x.across, sx * x.pivot + p["inertia"] * x.along, sy * x.pivot

    def potential(self, x: BodyVariables, p: Values) -> sp.Expr:
        """-g (first moment)."""
        return -(p["moment_x"] * x.gravity[0] + p["moment_y"] * x.gravity[1])


def _carried(arm: Arm, number: int | None) -> bool:
    """Whether other joints move the link before this one."""
    if number is None:
        return False
    before = joint_of(arm, number).antecedent
    while before is not None and before not in arm.coordinates:
        before = arm.joints[before].antecedent
    return before is not None
