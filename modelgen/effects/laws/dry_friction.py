"""Dry friction that depends on more than the direction."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import sympy as sp

from modelgen.description.objects import Arm
from modelgen.effects.base import ANY, POSITIVE, Parameter, Values, at
from modelgen.effects.laws.velocity_friction import (
    SMOOTHING,
    CoulombFriction,
    Friction,
    ViscousFriction,
    direction,
    powered,
)
from modelgen.effects.traits import Numbers, Presence, Seen, Shows
from modelgen.effects.variables import Variables

QUICKEST = 10.0  # s, of a drive that warms up
RISE = 2e-3  # s: long before what a band of some ten Hz shows


class StribeckFriction(Friction):
    """Dry friction that falls from its value near rest to the Coulomb level."""

    name = "stribeck_friction"
    text = "dry friction in excess of Coulomb's at low speed"
    finding = "dry friction in {drive} is larger at low speed"
    reference = "Stribeck 1902; Bo and Pavelescu 1982"
    varies = (CoulombFriction,)
    linear = (Parameter("magnitude", "{f}", "excess of static over Coulomb friction", "FS"),)
    nonlinear = (
        Parameter(
            "velocity",
            "{x}/s",
            "Stribeck velocity",
            bounds=POSITIVE,
            scale="speed",
            grid=(0.01, 0.02, 0.04, 0.08, 0.16, 0.3),
        ),
        Parameter(
            "exponent",
            "1",
            "shape of the fall",
            default=2.0,
            bounds=(0.5, 4.0),
            forms=(1.0, 2.0),  # Bo and Pavelescu 1982; Armstrong-Helouvry 1991
        ),
        SMOOTHING,
    )
    shows = frozenset({Shows.NEAR_REST, Shows.REVERSALS, Shows.BRIEFLY})
    confused_with = ("presliding", "backlash", "nonlinear_viscous_friction", "time_delay")
    experiment = "slow constant speeds around the Stribeck velocity, both directions"
    shown = at(magnitude=0.1, velocity=8.0)

    def law(self, x: Variables, p: Values) -> sp.Expr:
        """FS exp(-|v / v_s|^exponent) sign(v)."""
        power = powered(x.velocity / p["velocity"], p["exponent"])
        return p["magnitude"] * sp.exp(-power) * direction(x.velocity, p["smoothing"])


class LoadDependentFriction(Friction):
    """Dry friction in proportion to the load that the transmission carries."""

    name = "load_dependent_friction"
    seen_over = "load"
    text = "dry friction in proportion to the load that the transmission carries"
    finding = "friction in {drive} grows with the load: {coefficient:%} of it"
    reference = "Gogoussis and Donath 1988; Hamon, Gautier and Garrec 2010"
    varies = (CoulombFriction,)
    linear = (Parameter("coefficient", "1", "friction per load", "FL"),)
    nonlinear = (
        SMOOTHING,
        Parameter(
            "rise",
            "s",
            "0: the load is the weight of the links alone; above: it is all that moves them, weight and "
            "inertia, which it follows within this time",
            default=0.0,
            bounds=(0.0, 1.0),
            structural=True,
            forms=(None, RISE),
        ),
    )
    states = ("load",)
    shows = frozenset({Shows.LOAD})
    confused_with = ("position_dependent_friction", "drive_gain_error")
    experiment = "the same path with two payloads"
    shown = at(coefficient=0.15)

    @classmethod
    def held(cls, p: Mapping[str, sp.Expr | float]) -> tuple[str, ...]:
        """The weight follows from where the arm is."""
        return cls.states if p.get("rise", 0.0) != 0 else ()

    def law(self, x: Variables, p: Values) -> sp.Expr:
        """FL |load| sign(v): the load is the weight of the links, where rise is above 0 their inertia too."""
        load = x.state.get("load", x.load)
        return p["coefficient"] * sp.Abs(load) * direction(x.velocity, p["smoothing"])

    def step(self, x: Variables, p: Values, dt: sp.Symbol) -> Mapping[str, sp.Expr]:
        """Exact solution of rise dload/dt = force - load at a constant force that moves the links.

        Without a rise the friction would depend on the acceleration that it changes.
        """
        load = x.state.get("load")
        return {} if load is None else {"load": x.carried + (load - x.carried) * sp.exp(-dt / p["rise"])}


class PositionDependentFriction(Friction):
    """Dry friction that changes along the joint's range."""

    name = "position_dependent_friction"
    seen_over = "position"
    text = "dry friction that changes with the joint coordinate"
    finding = "friction in {drive} changes with the position"
    reference = "Armstrong 1988; Popovic and Goldenberg 1998"
    varies = (CoulombFriction,)
    linear = (
        Parameter("slope", "{f}/{q}", "change over the joint's position", "FP", bounds=ANY),
        Parameter("curvature", "{f}/{q}^2", "change over its square", "FQ", bounds=ANY),
    )
    nonlinear = (SMOOTHING,)
    shows = frozenset({Shows.PLACES, Shows.LOAD})
    series = True
    confused_with = ("load_dependent_friction",)
    experiment = "small reversals at many places of the range, with and without payload"
    shown = at(slope=0.04, curvature=0.02)

    def law(self, x: Variables, p: Values) -> sp.Expr:
        """(FP q + FQ q^2) sign(v)."""
        size = p["slope"] * x.q + p["curvature"] * x.q**2
        return size * direction(x.velocity, p["smoothing"])


class FrictionWarmUp(Friction):
    """Friction in excess of the warm drive's.

    Friction itself warms the drive: power in proportion to speed, as that of dry friction, against losses in
    proportion to the heat. A record begins cold, also one that is cut from the middle of a log, or as warm as
    the record left the drive that it runs on from.
    """

    name = "friction_warm_up"
    seen_over = "time"
    text = "friction that falls as the drive's own motion warms it up, from a cold start"
    finding = "friction in {drive} falls as the drive warms up"
    reference = "Bittencourt and Gunnarsson 2012; Simoni, Beschi, Legnani and Visioli 2015"
    varies = (CoulombFriction, ViscousFriction)
    linear = (
        Parameter("dry", "{f}", "excess of dry friction, cold", "FCW", bounds=ANY),
        Parameter("viscous", "{f} s/{x}", "excess of viscous friction, cold", "FVW", bounds=ANY),
    )
    nonlinear = (
        Parameter(
            "time",
            "s",
            "time constant of the warm-up",
            bounds=(1.0, float("inf")),  # windings of the smallest motors take a second
            scale="time",
            grid=(0.05, 0.1, 0.2, 0.4, 0.8, 1.6),
        ),
        Parameter(
            "speed",
            "{x}/s",
            "mean speed at which the heat settles at 1",
            bounds=POSITIVE,
            scale="speed",
            grid=(1.0,),
        ),
        SMOOTHING,
    )
    states = ("heat",)
    parts = (("dry",), ("viscous",))
    presence = Presence.FADING
    needs_effort = True
    confused_with = ("payload_change",)
    experiment = "the same motion cold and warm"
    shown = at(dry=0.1, viscous=0.0003, time=5.0, speed=36.0)

    @classmethod
    def impossible(cls, arm: Arm, number: int | None, values: Numbers) -> str:
        """A drive's housing warms in minutes, its oil film in tens of seconds."""
        if values["time"] < QUICKEST:
            return f"no drive warms with a time constant of {values['time']:.2g} s; {QUICKEST:.0f} s is quick"
        if values.get("dry", 0.0) + values.get("viscous", 0.0) * values.get("speed", 0.0) < 0.0:
            return "friction would grow as the drive warms"
        return ""

    @classmethod
    def hidden(cls, arm: Arm, seen: Seen, named: bool) -> list[str]:
        """It is hidden where drives were warmed before."""
        text = "a record begins in the middle of a log: how warm the drives were is not known"
        return [] if named or seen.whole else [text]

    def law(self, x: Variables, p: Values) -> sp.Expr:
        """(1 - heat) (FCW sign(v) + FVW v); time dheat/dt = |v| / speed - heat, 0 at a record's begin."""
        excess = p["dry"] * direction(x.velocity, p["smoothing"]) + p["viscous"] * x.velocity
        return (1 - x.state["heat"]) * excess

    def step(self, x: Variables, p: Values, dt: sp.Symbol) -> Mapping[str, sp.Expr]:
        """Exact solution at constant v."""
        settled = sp.Abs(x.velocity) / p["speed"]
        return {"heat": settled + (x.state["heat"] - settled) * sp.exp(-dt / p["time"])}


class Presliding(Friction):
    """Dry friction that builds up over a distance after each reversal."""

    name = "presliding"
    seen_over = "position"
    text = "dry friction that builds up over a distance after a reversal"
    finding = "friction in {drive} builds up over a distance after each reversal"
    reference = "Dahl 1968"
    varies = (CoulombFriction,)
    linear = (Parameter("magnitude", "{f}", "friction once it has built up", "FD"),)
    nonlinear = (
        Parameter(
            "distance",
            "{x}",
            "distance over which it builds up",
            bounds=POSITIVE,
            scale="span",
            grid=(3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1),
        ),
    )
    states = ("bend",)
    shows = frozenset({Shows.NEAR_REST, Shows.REVERSALS})
    confused_with = ("stribeck_friction", "backlash", "time_delay")
    experiment = "reversals of small amplitude, at several amplitudes and speeds"
    shown = at(magnitude=0.1, distance=6.0)
    laws = MappingProxyType({"friction": "magnitude", "bristle": "distance"})

    @classmethod
    def simulated(cls, values: Numbers) -> Mapping[str, float]:
        """Bristles, or where there are none what it comes to over distances."""
        return {"friction": values["magnitude"], "bristle": values["distance"]}

    def law(self, x: Variables, p: Values) -> sp.Expr:
        """FD z, where z is the bend of the bristles, from -1 to 1."""
        return p["magnitude"] * x.state["bend"]

    def step(self, x: Variables, p: Values, dt: sp.Symbol) -> Mapping[str, sp.Expr]:
        """Exact solution of dz/dt = (v - |v| z) / distance at constant v."""
        s = sp.sign(x.velocity)
        fade = sp.exp(-sp.Abs(x.velocity) * dt / p["distance"])
        # at rest the bend stays as it is: fade is then 1
        return {"bend": s + (x.state["bend"] - s) * fade}
