"""The equations of one arm with its drives and effects, in one graph.

Row by row, with K = torque_constant k1 and the drive's own terms at the motor coordinate:

    input = (rigid-body effort + joint-side effects) / K + motor-side effects / torque_constant
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property

import sympy as sp

from modelgen.description.objects import Arm
from modelgen.effects import AppliedEffect, applied_effects, free_symbol
from modelgen.errors import InputError
from modelgen.geometry import Frames, Scalars, Trigonometry
from modelgen.graph import Expr, Graph
from modelgen.graph.from_sympy import from_sympy
from modelgen.graph.vectors import Vector, add
from modelgen.model.motion import Rates
from modelgen.model.parameters import StandardParameter, effect_parameters, link_parameters
from modelgen.transmission import Transmission, of_joint


class Drive:
    """A coordinate's transmission in the graph; each part is made when it is first asked for."""

    def __init__(self, transmission: Transmission, convert: Callable[[sp.Expr], Expr]) -> None:
        self.transmission = transmission
        self._convert = convert

    def make(self) -> None:
        """Make all parts, in the order of the printed code."""
        _ = self.motor, self.k1, self.slope, self.inverse_gain

    @cached_property
    def motor(self) -> Expr:
        """q_m."""
        return self._convert(self.transmission.motor())

    @cached_property
    def k1(self) -> Expr:
        """dq_m/dq."""
        return self._convert(self.transmission.k1())

    @cached_property
    def slope(self) -> Expr:
        """d^2 q_m/dq^2."""
        return self._convert(self.transmission.slope())

    @cached_property
    def inverse_gain(self) -> Expr:
        """1/K."""
        return self._convert(self.transmission.inverse_gain())


class Equations:
    """Graph, frames, drives, effects and standard parameters of one arm.

    `runtime` keeps the arm's geometry symbols as inputs `geometry`; `sincos` takes sine and cosine
    of the joint angles as inputs; `free` names parameters of effects, otherwise fixed, that are the
    input `free`. `lazy` leaves out of the graph what nothing asks for of the drives: quicker, but the order
    of values, and with it of what is printed, then depends on who asks first.
    """

    def __init__(
        self,
        arm: Arm,
        runtime: bool = False,
        sincos: bool = False,
        free: Sequence[str] = (),
        *,
        lazy: bool = False,
    ) -> None:
        self.arm = arm
        self.graph = Graph()
        self.effects = applied_effects(arm, free)
        self.scalars = Scalars(self.graph, arm, runtime)
        lags, lag_rates = self._lags()
        self.trigonometry = Trigonometry(arm, self.scalars, sincos, lags)
        self.frames = Frames(arm, self.scalars, self.trigonometry, lag_rates=lag_rates)
        self.frames_factored = Frames(arm, self.scalars, self.trigonometry, True, lag_rates)
        self.n = len(arm.coordinates)
        self.free = {free_symbol(name): self.graph.input("free", k) for k, name in enumerate(free)}
        self.drives = [self._drive(n, index) for n, index in enumerate(arm.coordinates)]
        for drive in () if lazy else self.drives:
            drive.make()
        self.standard = standard_parameters(arm, self.effects)
        self.per_link = 14 if arm.fluid_density else 10

    @property
    def ideal_inputs(self) -> bool:
        """Whether no effect stands between the inputs and the efforts."""
        return not any(part.place == "input" for effect in self.effects for part in effect.parts)

    def vector(self, name: str) -> list[Expr]:
        """The input vector `name`, one element per coordinate."""
        return [self.graph.input(name, i) for i in range(self.n)]

    def zeros(self) -> list[Expr]:
        """One constant zero per coordinate."""
        return [self.graph.zero] * self.n

    def link_values(self, values: Sequence[Expr]) -> list[Sequence[Expr]]:
        """The links' part of a standard vector, link by link."""
        k = self.per_link
        return [values[k * i : k * (i + 1)] for i in range(len(self.arm.joints))]

    # -- drives ---------------------------------------------------------------------------

    def _drive(self, n: int, index: int) -> Drive:
        transmission = of_joint(self.arm, self.arm.joints[index])
        return Drive(transmission, self._converter(n, transmission))

    def _converter(self, n: int, transmission: Transmission) -> Callable[[sp.Expr], Expr]:
        symbols = {**self.scalars.symbols, transmission.q: self.graph.input("q", n)}

        def convert(expression: sp.Expr) -> Expr:
            with self.graph.noted(f"joint {self.arm.joints[self.arm.coordinates[n]].name}: drive"):
                return from_sympy(
                    self.graph,
                    expression,
                    symbols,
                    lambda angle: self.trigonometry.lookup(n, transmission.q, angle),
                )

        return convert

    def motor_rates(self, n: int, rates: Rates) -> tuple[Expr, Expr]:
        """dq_m and ddq_m of coordinate n; with a reference motion ddq_m is the reference's."""
        drive, dq = self.drives[n], rates.dq[n]
        other = dq if rates.reference is None else rates.reference[n]
        return drive.k1 * dq, drive.k1 * rates.ddq[n] + drive.slope * (dq * other)

    def state_names(self) -> list[str]:
        """Names of all states of the effects, in the order of the input `state`."""
        return [symbol.name for effect in self.effects for symbol in effect.states.values()]

    def _lags(self) -> tuple[dict[int, Expr], dict[int, Expr]]:
        """How far, and how fast, links stay behind their drives, by coordinate: states of effects."""
        lags: dict[int, Expr] = {}
        rates: dict[int, Expr] = {}
        names = self.state_names()
        for effect in self.effects:
            if effect.elastic and effect.joint is not None:
                n = self.arm.coordinates.index(effect.joint)
                lag, rate = (self.graph.input("state", names.index(s.name)) for s in effect.states.values())
                lags[n] = lags[n] + lag if n in lags else lag
                rates[n] = rates[n] + rate if n in rates else rate
        return lags, rates

    def link_line(self, index: int) -> tuple[Vector, Vector]:
        """Ends of a link in its frame [m]: it begins at its origin as drawn, and at the next link's, or
        at the tip given for the last. A slide that it carries counts where it is at zero: the link is
        rigid.
        """
        begin = self.drawn(index, (self.graph.zero, self.graph.zero, self.graph.zero))
        for frame in self.frames.frames:
            if frame.antecedent == index:
                joint = self.arm.joints[frame.index]
                r = self.scalars(joint.r) if frame.prismatic and joint.moving else frame.r
                along = (self.graph.zero, self.graph.zero, r + self.scalars(joint.lift))
                return begin, add(frame.foot, frame.to_antecedent_fixed(along))
        return begin, self.drawn(index, self._tip(index))

    def drawn(self, index: int, place: Vector) -> Vector:
        """A place [m] in the frame of a link as it is drawn, in the frame that the equations have."""
        return place[0], place[1], place[2] + self.scalars(self.arm.joints[index].lift)

    def _tip(self, index: int) -> Vector:
        """Tip of a link that carries no other: as given, or twice as far as its centre of mass."""
        joint = self.arm.joints[index]
        for effect in self.effects:
            if effect.joint in (None, index) and "tip_x" in effect.values:
                given = [float(effect.values[f"tip_{axis}"]) for axis in "xyz"]
                link = self.arm.links[index]
                if not any(given) and link is not None:
                    given = [2 * x for x in link.com]
                if any(given):
                    return self.graph.const(given[0]), self.graph.const(given[1]), self.graph.const(given[2])
                raise InputError(
                    f"{effect.effect.name} needs the end of link {joint.name}, which carries no other: "
                    "tip_x, tip_y, tip_z [m] in its frame, or its nominal inertials",
                    self.arm.where,
                )
        return self.graph.zero, self.graph.zero, self.graph.zero


def standard_parameters(arm: Arm, effects: Sequence[AppliedEffect]) -> tuple[StandardParameter, ...]:
    """All standard parameters: ten (fourteen in a fluid) a link, then the effects', joint after joint."""
    result: list[StandardParameter] = []
    for i, joint in enumerate(arm.joints):
        result += link_parameters(i, joint.name, bool(arm.fluid_density))
    for effect in effects:
        result += effect_parameters(arm, effect)
    return tuple(result)
