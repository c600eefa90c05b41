"""The effects of an arm in its graph: columns, forces, inertia, stored energy, states."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache

import sympy as sp

from modelgen.effects import TIME_STEP, AppliedEffect, InputVariables, Part
from modelgen.graph import Expr
from modelgen.graph.vectors import minus
from modelgen.model.effect_ports import Ports, number
from modelgen.model.equations import Equations
from modelgen.model.motion import Rates
from modelgen.model.ports import Surroundings


class EffectForces:
    """The effects at the motion `rates`, with the standard vector `values` where it is known."""

    def __init__(self, equations: Equations, rates: Rates, values: Sequence[Expr] | None = None) -> None:
        self.e = equations
        self.graph = equations.graph
        self.rates = rates
        links = None if values is None else equations.link_values(values)
        self.ports = Ports(equations, rates, Surroundings(equations.frames, rates, links))
        self.parameters: dict[sp.Symbol, Expr] = {}
        if values is not None:
            index = {parameter.name: i for i, parameter in enumerate(equations.standard)}
            for effect in equations.effects:
                self.parameters |= {s: values[index[s.name]] for _, s in effect.parameters}

    # -- sums over the effects --------------------------------------------------------------

    def columns(self) -> list[dict[int, Expr]]:
        """{coordinate: input per unit} of every effect parameter, in the order of the standard vector."""
        found = []
        for effect in self.e.effects:
            for _, symbol in effect.parameters:
                column: dict[int, Expr] = {}
                unit = {s: sp.Integer(s == symbol) for _, s in effect.parameters}  # forces are linear in them
                for part in self._parts(effect):
                    slopes = [sp.sympify(force).xreplace(unit) for force in part.forces]
                    for n, x in self._inputs(effect, part, slopes).items():
                        column[n] = column[n] + x if n in column else x
                found.append(column)
        return found

    def inputs(self) -> list[Expr]:
        """Forces that the effects add to the input, by coordinate."""
        motor, joint = self.at_motors(), self._forces("others")
        return [motor[n] + joint[n] * drive.inverse_gain for n, drive in enumerate(self.e.drives)]

    def at_motors(self) -> list[Expr]:
        """Forces that the effects at the motors add to the input."""
        forces = self._forces("motor")
        return [
            forces[n] / self.graph.const(drive.transmission.torque_constant)
            for n, drive in enumerate(self.e.drives)
        ]

    def efforts(self) -> list[Expr]:
        """The effects as efforts at the joints [N m or N], by coordinate."""
        motor, joint = self._forces("motor"), self._forces("others")
        return [motor[n] * drive.k1 + joint[n] for n, drive in enumerate(self.e.drives)]

    def masses(self, stored: bool = False) -> list[list[Expr]]:
        """Mass matrix n x n that the effects add; `stored`: of the masses that move with the joints alone."""
        n = self.e.n
        total = [[self.graph.zero] * n for _ in range(n)]
        for effect in self.e.effects:
            for part in self._parts(effect):
                if stored and part.place == "transmission":
                    continue
                for row, column, mass in self._masses(effect, part):
                    total[row][column] = total[row][column] + mass
        return total

    def potential(self) -> Expr:
        """Energy stored in the effects [J], up to a constant."""
        total = self.graph.zero
        for effect in self.e.effects:
            if effect.potential != 0:
                total = total + self.in_graph(effect, effect.parts[0], effect.potential)
        return total

    def required(self, inputs: Sequence[Expr]) -> list[Expr]:
        """Inputs that give the efforts which `inputs` give of ideal drives."""
        return self._passed(inputs, 0)

    def effective(self, inputs: Sequence[Expr]) -> list[Expr]:
        """Inputs of ideal drives with the efforts of these ones at `inputs`."""
        return self._passed(inputs, 1)

    def steps(self, dt: Expr) -> list[Expr]:
        """The states after dt, in their order."""
        found = []
        for effect in self.e.effects:
            for name in effect.states:
                found.append(self.in_graph(effect, effect.parts[0], effect.steps[name], {TIME_STEP: dt}))
        return found

    # -- one part of an effect --------------------------------------------------------------

    def _parts(self, effect: AppliedEffect) -> list[Part]:
        """Leave out the lines of links that have no length."""
        return [p for p in effect.parts if not (p.point and p.point.place is None and self._short(p.joint))]

    def _short(self, link: int) -> bool:
        begin, end = self.e.link_line(link)
        return all(e.is_zero for e in minus(end, begin))

    def _forces(self, kind: str) -> list[Expr]:
        """Sums of the forces at the motor coordinates, or of the efforts of all others."""
        total = self.e.zeros()
        for effect in self.e.effects:
            for part in self._parts(effect):
                if part.place == "input" or (part.place == "motor") != (kind == "motor"):
                    continue
                for n, x in self._efforts(effect, part, part.forces).items():
                    total[n] = total[n] + x
        return total

    def _efforts(self, effect: AppliedEffect, part: Part, forces: Sequence[sp.Expr]) -> dict[int, Expr]:
        """{coordinate: effort} of forces at the part's port; of the motor's own for place "motor"."""
        found: dict[int, Expr] = {}
        port = self.ports.of(effect, part)
        for row, force in zip(port.rows[: len(forces)], forces, strict=True):  # few have a moment
            if force == 0:
                continue
            value = self.in_graph(effect, part, force)
            for n, x in row.items():
                term = value if part.place == "motor" else x * value
                found[n] = found[n] + term if n in found else term
        return found

    def _inputs(self, effect: AppliedEffect, part: Part, forces: Sequence[sp.Expr]) -> dict[int, Expr]:
        """{coordinate: input} of forces at the part's port."""
        efforts = self._efforts(effect, part, forces)
        if part.place != "motor":
            return {n: x * self.e.drives[n].inverse_gain for n, x in efforts.items()}
        return {
            n: x / self.graph.const(self.e.drives[n].transmission.torque_constant) for n, x in efforts.items()
        }

    def _masses(self, effect: AppliedEffect, part: Part) -> list[tuple[int, int, Expr]]:
        if part.place == "input":
            return []
        port = self.ports.of(effect, part)
        found = []
        moved = port.rows[: len(port.accelerations)]
        for row, force in zip(port.rows[: len(part.forces)], part.forces, strict=True):
            for other, acceleration in zip(moved, port.accelerations, strict=True):
                slope = _slope(force, acceleration)
                if slope == 0:
                    continue
                mass = self.in_graph(effect, part, slope)
                found += [(n, m, mass * (x * y)) for n, x in row.items() for m, y in other.items()]
        return found

    def _passed(self, inputs: Sequence[Expr], which: int) -> list[Expr]:
        total = list(inputs)
        for effect in self.e.effects:
            for part in effect.parts:
                if isinstance(part.variables, InputVariables):
                    n = number(self.e, part)
                    assert n is not None
                    bound = {part.variables.input: total[n]}
                    total[n] = self.in_graph(effect, part, part.forces[which], bound)
        return total

    def in_graph(
        self,
        effect: AppliedEffect,
        part: Part,
        expression: sp.Expr,
        more: Mapping[sp.Symbol, Expr] | None = None,
    ) -> Expr:
        """An expression over the part's variables as a value of the graph."""
        known: dict[sp.Symbol, Expr] = {**self.e.scalars.symbols, **self.e.free, **self.parameters}
        known |= self._states(effect) | dict(more or {})
        x = part.variables
        lazy = self.ports.lazy(part)
        port = {} if isinstance(x, InputVariables) else self.ports.of(effect, part).bound
        for symbol in sp.sympify(expression).free_symbols - known.keys():
            known[symbol] = port[symbol] if symbol in port else lazy[symbol]()
        with self.graph.noted(f"joint {self.e.arm.joints[part.joint].name}: {effect.effect.name}"):
            return self.ports.converted(part, expression, known)

    def _states(self, effect: AppliedEffect) -> dict[sp.Symbol, Expr]:
        names = self.e.state_names()
        return {s: self.graph.input("state", names.index(s.name)) for s in effect.states.values()}


@lru_cache(maxsize=1024)
def _slope(force: sp.Expr, by: sp.Symbol) -> sp.Expr:
    return sp.diff(force, by)
