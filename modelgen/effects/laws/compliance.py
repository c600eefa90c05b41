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

STIFFNESS = Parameter(
    "stiffness",
    "{f}/{x}",
    "stiffness between drive and link; of a lever, at the joint in mid-stroke",
    bounds=POSITIVE,
)
DAMPING = Parameter("damping", "{f} s/{x}", "damping between drive and link", default=0.0)


class Compliance(Effect):
    """What elastic joints and play share.

    It lies at the motor. Where a lever's ratio changes along the stroke, stiffness, damping and play are
    those at the joint in the middle of it.
    """

    place = "transmission"
    states = ("lag", "rate")

    @abstractmethod
    def spring(self, stretch: sp.Expr, p: Values) -> tuple[sp.Expr, sp.Expr]:
        """Force of the spring at a stretch, and 1 where it touches, else 0."""

    def law(self, x: Variables, p: Values) -> sp.Expr:
        """Minus the acceleration of the lag: (spring + damping rate - transmitted) / inertia."""
        return (self._effort(x, p) - x.transmitted) / x.inertia

    def beside(self, x: Variables, p: Values) -> sp.Expr:
        """A lever turns the actuator's force into effort where the link is, the drive's gain where it is."""
        lever = x.transmission.leverage()
        if not lever.has(x.transmission.q):
            return sp.Integer(0)
        here, there = (lever.subs(x.transmission.q, q) for q in (x.q, x.q - x.state["lag"]))
        return (here / there - 1) * self._effort(x, p)

    def step(self, x: Variables, p: Values, dt: sp.Symbol) -> Mapping[str, sp.Expr]:
        """The implicit midpoint rule, the spring taken as linear over the step: stable for any stiffness."""
        lag, rate = x.state["lag"], x.state["rate"]
        stretch, lever = self._stretch(x)
        force, touching = self.spring(stretch, p)
        half = dt / 2 / x.inertia * touching * lever**2 * (p["damping"] + p["stiffness"] * dt / 2)
        after = (rate * (1 - half) + dt * (x.transmitted - lever * force) / x.inertia) / (1 + half)
        return {"lag": lag + dt * (rate + after) / 2, "rate": after}

    def _effort(self, x: Variables, p: Values) -> sp.Expr:
        """What spring and damper do to the link."""
        stretch, lever = self._stretch(x)
        force, touching = self.spring(stretch, p)
        return lever * (force + p["damping"] * touching * lever * x.state["rate"])

    def _stretch(self, x: Variables) -> tuple[sp.Expr, sp.Expr]:
        """How far the drive is ahead, as the joint moves in the middle of the stroke, and the drive's ratio
        where the link is over that in the middle.
        """
        drive, lag = x.transmission, x.state["lag"]
        lever = drive.leverage()
        if not lever.has(drive.q):
            return lag, lever
        evened = drive.evened()
        return evened.subs(drive.q, x.q) - evened.subs(drive.q, x.q - lag), lever.subs(drive.q, x.q - lag)


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

    def spring(self, stretch: sp.Expr, p: Values) -> tuple[sp.Expr, sp.Expr]:
        """stiffness times stretch."""
        return p["stiffness"] * stretch, sp.Integer(1)


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

    def spring(self, stretch: sp.Expr, p: Values) -> tuple[sp.Expr, sp.Expr]:
        """stiffness times what the stretch exceeds the gap by."""
        half = p["play"] / 2
        # not evaluated: what SymPy asks of a lever's stretch takes longer than everything else
        within = sp.Max(-half, sp.Min(half, stretch, evaluate=False), evaluate=False)
        beyond = stretch - within
        return p["stiffness"] * beyond, sp.sign(sp.Abs(beyond, evaluate=False), evaluate=False)
