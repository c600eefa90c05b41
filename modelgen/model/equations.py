"""The equations of one arm with its drives and effects, in one graph.

Row by row, with K = torque_constant k1 and the drive's own terms at the motor coordinate:

    input = (rigid-body effort + joint-side effects) / K + motor-side effects / torque_constant
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from modelgen.description.objects import Arm
from modelgen.effects import AppliedEffect, applied_effects
from modelgen.geometry import Frames, Scalars, Trigonometry
from modelgen.graph import Expr, Graph
from modelgen.graph.from_sympy import from_sympy
from modelgen.model.motion import Rates
from modelgen.model.parameters import StandardParameter, effect_parameters, link_parameters
from modelgen.transmission import Transmission, of_joint


@dataclass(frozen=True)
class Drive:
    """A coordinate's transmission in the graph: k1 = dq_m/dq, slope = d^2 q_m/dq^2, 1/K."""

    transmission: Transmission
    motor: Expr
    k1: Expr
    slope: Expr
    inverse_gain: Expr


class Equations:
    """Graph, frames, drives, effects and standard parameters of one arm.

    `runtime` keeps the arm's geometry symbols as inputs `geometry`; `sincos` takes sine and cosine
    of the joint angles as inputs.
    """

    def __init__(self, arm: Arm, runtime: bool = False, sincos: bool = False) -> None:
        self.arm = arm
        self.graph = Graph()
        self.scalars = Scalars(self.graph, arm, runtime)
        self.trigonometry = Trigonometry(arm, self.scalars, sincos)
        self.frames = Frames(arm, self.scalars, self.trigonometry)
        self.frames_factored = Frames(arm, self.scalars, self.trigonometry, factored=True)
        self.n = len(arm.coordinates)
        self.effects = applied_effects(arm)
        self.drives = [self._drive(n, index) for n, index in enumerate(arm.coordinates)]
        self.standard = standard_parameters(arm, self.effects)
        self.per_link = 14 if arm.fluid_density else 10

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
        convert = self._converter(n, transmission)
        return Drive(
            transmission,
            convert(transmission.motor()),
            convert(transmission.k1()),
            convert(transmission.slope()),
            convert(transmission.inverse_gain()),
        )

    def _converter(self, n: int, transmission: Transmission) -> Callable[[sp.Expr], Expr]:
        symbols = {**self.scalars.symbols, transmission.q: self.graph.input("q", n)}

        def convert(expression: sp.Expr) -> Expr:
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

    # -- effects --------------------------------------------------------------------------

    def bindings(self, effect: AppliedEffect, rates: Rates) -> dict[sp.Symbol, Expr]:
        """The variables of an effect's law in the graph."""
        n, x = effect.coordinate, effect.variables
        if effect.side == "motor":
            velocity, acceleration = self.motor_rates(n, rates)
            position = self.drives[n].motor
        else:
            position, velocity, acceleration = self.graph.input("q", n), rates.dq[n], rates.ddq[n]
        states = self.state_names()
        bound = {x.position: position, x.velocity: velocity, x.acceleration: acceleration}
        for name, symbol in x.state.items():
            bound[symbol] = self.graph.input("state", states.index(state_name(effect, name)))
        return bound

    def state_names(self) -> list[str]:
        """Names of all states of the effects, in the order of the input `state`."""
        return [state_name(effect, name) for effect in self.effects for name in effect.variables.state]

    def parameter_bindings(self, values: Sequence[Expr]) -> dict[sp.Symbol, Expr]:
        """Symbols of the effects' linear parameters to elements of a standard vector."""
        index = {parameter.name: i for i, parameter in enumerate(self.standard)}
        return {
            symbol: values[index[symbol.name]] for effect in self.effects for _, symbol in effect.parameters
        }

    def in_graph(self, effect: AppliedEffect, law: sp.Expr, bound: Mapping[sp.Symbol, Expr]) -> Expr:
        """An expression over an effect's variables and parameters as a value of the graph."""
        return from_sympy(self.graph, law, bound)

    def effect_columns(self, rates: Rates) -> list[tuple[int, Expr]]:
        """(coordinate, input per unit) of every effect parameter, in the order of the standard vector."""
        columns = []
        for effect in self.effects:
            bound = self.bindings(effect, rates)
            for _, symbol in effect.parameters:
                column = self.in_graph(effect, sp.diff(effect.law, symbol), bound)
                columns.append((effect.coordinate, self.to_input(effect, column)))
        return columns

    def to_input(self, effect: AppliedEffect, force: Expr) -> Expr:
        """A force at the effect's coordinate as a part of the input [A, or N m or N]."""
        drive = self.drives[effect.coordinate]
        if effect.side == "joint":
            return force * drive.inverse_gain
        return force / self.graph.const(drive.transmission.torque_constant)

    def effect_inputs(self, rates: Rates, values: Sequence[Expr]) -> list[Expr]:
        """What the effects add to the input, by coordinate."""
        total = self.zeros()
        parameters = self.parameter_bindings(values)
        for side in ("motor", "joint"):
            forces = self.zeros()
            for effect in self.effects:
                if effect.side == side:
                    bound = {**self.bindings(effect, rates), **parameters}
                    n = effect.coordinate
                    forces[n] = forces[n] + self.in_graph(effect, effect.law, bound)
            for n, drive in enumerate(self.drives):
                if side == "joint":
                    total[n] = total[n] + forces[n] * drive.inverse_gain
                else:
                    constant = self.graph.const(drive.transmission.torque_constant)
                    total[n] = total[n] + forces[n] / constant
        return total

    def effect_efforts(self, rates: Rates, values: Sequence[Expr]) -> list[Expr]:
        """The effects as efforts at the joints [N m or N], by coordinate."""
        total = self.zeros()
        parameters = self.parameter_bindings(values)
        for effect in self.effects:
            bound = {**self.bindings(effect, rates), **parameters}
            force = self.in_graph(effect, effect.law, bound)
            n = effect.coordinate
            total[n] = total[n] + (force * self.drives[n].k1 if effect.side == "motor" else force)
        return total

    def effect_masses(self, values: Sequence[Expr]) -> list[Expr]:
        """Inertia that the effects add to the diagonal of the mass matrix, by coordinate."""
        total = self.zeros()
        parameters = self.parameter_bindings(values)
        still = Rates(self.zeros(), self.zeros())
        for effect in self.effects:
            law = sp.diff(effect.law, effect.variables.acceleration)
            if law == 0:
                continue
            n = effect.coordinate
            mass = self.in_graph(effect, law, {**self.bindings(effect, still), **parameters})
            k1 = self.drives[n].k1
            total[n] = total[n] + (mass * (k1 * k1) if effect.side == "motor" else mass)
        return total

    def effect_potential(self, values: Sequence[Expr]) -> Expr:
        """Energy stored in the effects [J], up to a constant."""
        total = self.graph.zero
        parameters = self.parameter_bindings(values)
        still = Rates(self.zeros(), self.zeros())
        for effect in self.effects:
            if effect.potential != 0:
                bound = {**self.bindings(effect, still), **parameters}
                total = total + self.in_graph(effect, effect.potential, bound)
        return total


def state_name(effect: AppliedEffect, name: str) -> str:
    """A state's name in the arm: effect, state and joint number."""
    return f"{effect.effect.name}_{name}_{effect.joint + 1}"


def standard_parameters(arm: Arm, effects: Sequence[AppliedEffect]) -> tuple[StandardParameter, ...]:
    """All standard parameters: ten (fourteen in a fluid) a link, then the effects', joint after joint."""
    result: list[StandardParameter] = []
    for i, joint in enumerate(arm.joints):
        result += link_parameters(i, joint.name, bool(arm.fluid_density))
    for effect in effects:
        result += effect_parameters(arm, effect)
    return tuple(result)
