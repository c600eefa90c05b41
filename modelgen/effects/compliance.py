"""A link that does not follow its drive: an elastic joint, play in the gears.

The coordinate is the drive's, by which logs and controllers know the joint. The state is how far the
link stays behind it; its acceleration follows from the effort that a rigid joint would transmit, the
links' inertia about the joint and what the spring transmits instead. The links' equations are taken
where the links are.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping

import sympy as sp

from modelgen.effects.base import POSITIVE, Effect, Parameter, Values, at
from modelgen.effects.variables import Variables

STIFFNESS = Parameter("stiffness", "{f}/{x}", "stiffness between drive and link", bounds=POSITIVE)
DAMPING = Parameter("damping", "{f} s/{x}", "damping between drive and link", default=0.0)


class Compliance(Effect):
    """What elastic joints and play share."""

    place = "transmission"
    states = ("lag", "rate")

    @abstractmethod
    def spring(self, x: Variables, p: Values) -> tuple[sp.Expr, sp.Expr]:
        """Force of the spring at the present lag, and 1 where it touches, else 0."""

    def law(self, x: Variables, p: Values) -> sp.Expr:
        """Minus the acceleration of the lag: (spring + damping rate - transmitted) / inertia."""
        force, touching = self.spring(x, p)
        return (force + p["damping"] * touching * x.state["rate"] - x.transmitted) / x.inertia

    def step(self, x: Variables, p: Values, dt: sp.Symbol) -> Mapping[str, sp.Expr]:
        """The implicit midpoint rule, the spring taken as linear over the step: stable for any stiffness."""
        lag, rate = x.state["lag"], x.state["rate"]
        force, touching = self.spring(x, p)
        half = dt / 2 / x.inertia * touching * (p["damping"] + p["stiffness"] * dt / 2)
        after = (rate * (1 - half) + dt * (x.transmitted - force) / x.inertia) / (1 + half)
        return {"lag": lag + dt * (rate + after) / 2, "rate": after}


class JointFlexibility(Compliance):
    """An elastic transmission."""

    name = "joint_flexibility"
    seen_over = "position"
    text = "elastic transmission between drive and link"
    reference = "Spong 1987"
    nonlinear = (STIFFNESS, DAMPING)
    confused_with = ("backlash", "time_delay")
    experiment = "a chirp up to the resonance, with encoders on motor and link"
    shown = at(stiffness=4000.0, damping=60.0)

    def spring(self, x: Variables, p: Values) -> tuple[sp.Expr, sp.Expr]:
        """stiffness times lag."""
        return p["stiffness"] * x.state["lag"], sp.Integer(1)


class Backlash(Compliance):
    """Play between drive and link."""

    name = "backlash"
    seen_over = "position"
    text = "play between drive and link"
    reference = "Nordin and Gutman 2002"
    nonlinear = (
        Parameter(
            "play",
            "{x}",
            "width of the gap, from contact to contact",
            bounds=POSITIVE,
            scale="span",
            grid=(3e-4, 1e-3, 3e-3, 1e-2, 3e-2),
        ),
        STIFFNESS,
        DAMPING,
    )
    confused_with = ("joint_flexibility", "presliding", "time_delay")
    experiment = "a motion that reverses the load, with encoders on motor and link"
    shown = at(play=0.01, stiffness=30000.0, damping=300.0)

    def spring(self, x: Variables, p: Values) -> tuple[sp.Expr, sp.Expr]:
        """stiffness times what the lag exceeds the gap by."""
        lag, half = x.state["lag"], p["play"] / 2
        beyond = lag - sp.Max(-half, sp.Min(half, lag))
        return p["stiffness"] * beyond, sp.sign(sp.Abs(beyond))
