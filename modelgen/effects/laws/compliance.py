"""A link that does not follow its drive: an elastic joint, play in the gears.

The coordinate is the drive's, by which logs and controllers know the joint. The state is how far the
link stays behind it; its acceleration follows from the effort that a rigid joint would transmit, the
links' inertia about the joint and what the spring transmits instead. The links' equations are used
where the links are.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import replace

import sympy as sp

from modelgen.description.objects import Arm
from modelgen.effects.base import POSITIVE, Characteristic, Effect, Parameter, Values, at
from modelgen.effects.traits import Added, Family, Numbers, Reading, Seen, Shows
from modelgen.effects.variables import Variables
from modelgen.numeric import Array

STIFFNESS = Parameter(
    "stiffness",
    "{f}/{x}",
    "stiffness between drive and link; of a lever, at the joint in mid-stroke",
    bounds=POSITIVE,
)
DAMPING = Parameter("damping", "{f} s/{x}", "damping between drive and link", default=0.0)
# What is searched for: stiffness in units of the efforts and the motion, and damping over stiffness.
STIFFNESSES = (3.0, 8.0, 20.0, 50.0, 120.0, 300.0, 800.0, 3000.0)
HARD = 200.0  # of a spring in which something else shows first
RELAXATION = Parameter("relaxation", "s", "damping over stiffness", grid=(0.02,))
REACH = 0.012  # of the stretch that is drawn
LIGHT = replace(RELAXATION, grid=(0.002, 0.02))  # a link rings for long, or hardly
RINGS = replace(RELAXATION, grid=(0.005,))  # behind a link's own position the drive rings within less


def stiffness(*grid: float) -> Parameter:
    """Stiffness as it is searched for."""
    return replace(STIFFNESS, scale="stiffness", grid=grid)


class Compliance(Effect):
    """Elastic joints and play share this.

    It lies at the motor. Where a lever's ratio changes along the stroke, stiffness, damping and play are
    those at the joint in the middle of it.
    """

    place = "transmission"
    states = ("lag", "rate")
    family = Family.ELASTIC
    needs_effort = True

    @classmethod
    def hidden(cls, arm: Arm, seen: Seen, named: bool) -> list[str]:
        """It is hidden where nobody knows which position was measured."""
        there = [arm.joints[arm.coordinates[n - 1]].effects for n in seen.unsided]
        unsided = [
            n for n, uses in zip(seen.unsided, there, strict=True) if all(u.name != cls.name for u in uses)
        ]
        if not unsided:
            return []
        reason = "has no drive, or was measured now at the motor, now at the link"
        joints = ", ".join(arm.coordinate_names[n - 1] for n in unsided)
        return [f"the position of {joints} {'is too coarse to show it' if seen.coarse else reason}"]

    @classmethod
    def estimated(cls) -> tuple[str, ...]:
        """The share of what is simulated that the records have: it is in proportion to no parameter."""
        return ("share",)

    @classmethod
    def sought(cls, behind_link: bool) -> tuple[Parameter, ...]:
        """Stiffness, relaxation, and what else has a grid; behind a link's own position no law but a linear
        spring and a gap is simulated.
        """
        return () if behind_link else (stiffness(*STIFFNESSES), RELAXATION, *cls.searched())

    @classmethod
    def slopes(cls, names: Sequence[str], values: Numbers, added: Added) -> Array:
        """All that it does with these values, (N, n, 1)."""
        return added(cls.physical(values))[:, :, None]

    @classmethod
    def physical(cls, found: Numbers) -> dict[str, float]:
        """Damping from the relaxation."""
        own = {
            p.name: found[p.name] for p in cls.nonlinear if p.name in found and p not in (STIFFNESS, DAMPING)
        }
        return {**own, "stiffness": found["stiffness"], "damping": found["relaxation"] * found["stiffness"]}

    def characteristic(self, p: Values) -> Characteristic:
        """Force of the spring over its stretch."""
        stretch = sp.Symbol("stretch", real=True)
        return Characteristic(stretch, "stretch", "{x}", REACH, self.spring(stretch, p)[0])

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
        """The implicit midpoint rule, the spring linear over the step: stable for any stiffness."""
        lag, rate = x.state["lag"], x.state["rate"]
        stretch, lever = self._stretch(x)
        force, touching = self.spring(stretch, p)
        half = dt / 2 / x.inertia * touching * lever**2 * (p["damping"] + p["stiffness"] * dt / 2)
        after = (rate * (1 - half) + dt * (x.transmitted - lever * force) / x.inertia) / (1 + half)
        return {"lag": lag + dt * (rate + after) / 2, "rate": after}

    def _effort(self, x: Variables, p: Values) -> sp.Expr:
        """Effort of spring and damper at the link."""
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
    finding = "the transmission of {joint} is elastic"
    reference = "Spong 1987"
    nonlinear = (STIFFNESS, DAMPING)
    claims = (
        "stiffness",
    )  # which is as far from infinite, in its deviations, as its reciprocal is from zero

    @classmethod
    def sought(cls, behind_link: bool) -> tuple[Parameter, ...]:
        """Stiffness and relaxation."""
        return stiffness(*STIFFNESSES), RINGS if behind_link else LIGHT

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
    finding = "there is play between {drive} and its link"
    reference = "Nordin and Gutman 2002"
    nonlinear = (
        Parameter(
            "play",
            "{x}",
            "width of the gap, from contact to contact",
            bounds=POSITIVE,
            scale="span",
            grid=(3e-4, 8e-4, 2e-3, 4e-3, 1e-2, 3e-2),
        ),
        STIFFNESS,
        DAMPING,
    )
    shows = frozenset({Shows.IMPACTS})
    simpler = JointFlexibility
    confused_with = ("joint_flexibility", "presliding", "time_delay")
    reading = Reading(
        "the joint's angle to 0.1 mrad at the link, the motor held, the link pushed both ways",
        ("play",),
        1e-4,
        claim="a gap of {}",
    )
    experiment = "a motion that reverses the load, with encoders on motor and link"
    shown = at(play=0.01, stiffness=30000.0, damping=300.0)

    @classmethod
    def sought(cls, behind_link: bool) -> tuple[Parameter, ...]:
        """The gap first; behind a link's own position alone, since it shows at its edges alone."""
        play = cls.nonlinear[0]
        if behind_link:
            return (replace(play, grid=(3e-4, 1e-3, 3e-3, 6e-3, 1.2e-2)),)
        return play, stiffness(HARD), RELAXATION

    def spring(self, stretch: sp.Expr, p: Values) -> tuple[sp.Expr, sp.Expr]:
        """stiffness times what the stretch exceeds the gap by."""
        half = p["play"] / 2
        # not evaluated: what SymPy asks of a lever's stretch takes longer than everything else
        within = sp.Max(-half, sp.Min(half, stretch, evaluate=False), evaluate=False)
        beyond = stretch - within
        return p["stiffness"] * beyond, sp.sign(sp.Abs(beyond, evaluate=False), evaluate=False)
