"""The effects of an arm in its graph: columns, forces, inertia, stored energy, states."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property

import sympy as sp

from modelgen.effects import (
    TIME_STEP,
    AppliedEffect,
    BodyVariables,
    InputVariables,
    Part,
    PointVariables,
    Variables,
)
from modelgen.geometry.frames import turn_z
from modelgen.graph import Expr
from modelgen.graph.from_sympy import from_sympy
from modelgen.graph.vectors import Vector, add, cross, dot, minus, times
from modelgen.model.bodies import Swinging, body_port
from modelgen.model.equations import Equations
from modelgen.model.motion import LinkMotion, Rates, link_motions, of_links
from modelgen.model.ports import Port, Surroundings, origin_velocities, point_rows

Lazy = Callable[[], Expr]


class EffectForces:
    """The effects at the motion `rates`, with the standard vector `values` where it is known."""

    def __init__(self, equations: Equations, rates: Rates, values: Sequence[Expr] | None = None) -> None:
        self.e = equations
        self.graph = equations.graph
        self.rates = rates
        links = None if values is None else equations.link_values(values)
        self.around = Surroundings(equations.frames, rates, links)
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
        """What the effects add to the input, by coordinate."""
        motor, joint = self.at_motors(), self._forces("others")
        return [motor[n] + joint[n] * drive.inverse_gain for n, drive in enumerate(self.e.drives)]

    def at_motors(self) -> list[Expr]:
        """What those at the motors add to it."""
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
        """What the effects add to the mass matrix, n x n; `stored`: of what moves with the joints alone."""
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
        """Without the lines of links that have no length."""
        return [p for p in effect.parts if not (p.point and p.point.place is None and self._short(p.joint))]

    def _short(self, link: int) -> bool:
        begin, end = self.e.link_line(link)
        return all(e.is_zero for e in minus(end, begin))

    def _number(self, part: Part) -> int | None:
        """Coordinate of the part's joint."""
        coordinates = self.e.arm.coordinates
        return coordinates.index(part.joint) if part.joint in coordinates else None

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
        port = self._port(effect, part)
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
        port = self._port(effect, part)
        found = []
        moved = port.rows[: len(port.accelerations)]
        for row, force in zip(port.rows[: len(part.forces)], part.forces, strict=True):
            for other, acceleration in zip(moved, port.accelerations, strict=True):
                slope = sp.diff(force, acceleration)
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
                    n = self._number(part)
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
        lazy = self._lazy(part)
        port = {} if isinstance(x, InputVariables) else self._port(effect, part).bound
        for symbol in sp.sympify(expression).free_symbols - known.keys():
            known[symbol] = port[symbol] if symbol in port else lazy[symbol]()
        return self._converted(part, expression, known)

    def _converted(self, part: Part, expression: sp.Expr, known: Mapping[sp.Symbol, Expr]) -> Expr:
        x = part.variables
        if not isinstance(x, Variables | BodyVariables):
            return from_sympy(self.graph, expression, known)
        n = self._number(part)
        assert n is not None
        return from_sympy(
            self.graph, expression, known, lambda angle: self.e.trigonometry.lookup(n, x.q, angle)
        )

    def _states(self, effect: AppliedEffect) -> dict[sp.Symbol, Expr]:
        names = self.e.state_names()
        return {s: self.graph.input("state", names.index(s.name)) for s in effect.states.values()}

    # -- ports ------------------------------------------------------------------------------

    @cached_property
    def _motions(self) -> list[LinkMotion]:
        return link_motions(self.e.frames, self.rates)

    @cached_property
    def _velocities(self) -> list[Vector]:
        rates = of_links(self.e.frames, self.rates)
        return origin_velocities(self.e.frames, rates.dq, [m.velocity for m in self._motions])

    @cached_property
    def _references(self) -> list[Vector]:
        """Velocities of the origins in the reference motion."""
        rates = of_links(self.e.frames, self.rates)
        if rates.reference is None:
            return self._velocities
        return origin_velocities(self.e.frames, rates.reference, [m.reference for m in self._motions])

    def _port(self, effect: AppliedEffect, part: Part) -> Port:
        x = part.variables
        if isinstance(x, PointVariables):
            return self._point_port(x, part)
        if isinstance(x, BodyVariables):
            return body_port(self.e.frames, self._swinging(x, part), self.rates, self._motions, x)
        assert isinstance(x, Variables)
        n = self._number(part)
        assert n is not None
        q, dq, ddq = self.graph.input("q", n), self.rates.dq[n], self.rates.ddq[n]
        other = dq if self.rates.reference is None else self.rates.reference[n]
        drive = self.e.drives[n]
        row: Mapping[int, Expr] = {n: self.graph.one}
        if part.place == "motor":
            velocity, acceleration = self.e.motor_rates(n, self.rates)
            square = (drive.k1 * drive.k1) * (dq * other)
            bound = (drive.motor, velocity, acceleration, square)
            row = {n: drive.k1}
        elif part.place == "pair":
            m = int(effect.values["other"]) - 1
            ratio = from_sympy(self.graph, effect.values["ratio"], self.e.free)
            row = {n: self.graph.one, m: ratio}
            velocity = dq + ratio * self.rates.dq[m]
            reference = self.rates.dq if self.rates.reference is None else self.rates.reference
            square = velocity * (other + ratio * reference[m])
            position = q + ratio * self.graph.input("q", m)
            bound = (position, velocity, ddq + ratio * self.rates.ddq[m], square)
        else:
            bound = (q, dq, ddq, dq * other)
        symbols = (x.position, x.velocity, x.acceleration, x.square)
        rates: dict[sp.Symbol, Expr] = dict(zip(symbols, bound, strict=True))
        if part.place != "transmission":
            return Port((row,), rates, (x.acceleration,))
        column, transmitted = self.around.inertia(n), self.around.transmitted(n)
        if column is None or transmitted is None:
            return Port((), rates, ())
        rates |= {x.transmitted: transmitted, x.inertia: column[n]}
        return Port(({k: e for k, e in enumerate(column) if not e.is_zero},), rates, (x.transmitted,))

    def _point_port(self, x: PointVariables, part: Part) -> Port:
        assert part.point is not None
        i, motion = part.joint, self._motions[part.joint]
        begin, end = self.e.link_line(i)
        span = minus(end, begin)
        whole = self.graph.sqrt(dot(span, span))
        place = self._place(part, begin, span)
        line = span if whole.is_zero else (span[0] / whole, span[1] / whole, span[2] / whole)
        bound: dict[sp.Symbol, Expr] = {x.length: whole * part.point.part}
        for symbols, vector in (
            (x.velocity, add(self._velocities[i], cross(motion.velocity, place))),
            (x.turn, cross(motion.velocity, line)),
            (x.reference, add(self._references[i], cross(motion.reference, place))),
            (x.reference_turn, cross(motion.reference, line)),
            (x.acceleration, add(motion.acceleration, times(motion.field, place))),
            (x.gravity, motion.gravity),
            (x.line, line),
        ):
            bound |= dict(zip(symbols, vector, strict=True))
        return Port(point_rows(self.e.frames, i, place), bound, tuple(x.acceleration))

    def _swinging(self, x: BodyVariables, part: Part) -> Swinging:
        n, swing = self._number(part), part.swing
        assert n is not None
        assert swing is not None
        known = {**self.e.scalars.symbols, **self.e.free, x.q: self.graph.input("q", n)}
        parts = (swing.cosine, swing.sine, swing.turn, swing.bend, *swing.pivot)
        cosine, sine, turn, bend, *pivot = (self._converted(part, e, known) for e in parts)
        lift = self.e.scalars(self.e.arm.joints[part.joint].lift)
        return Swinging(part.joint, cosine, sine, turn, bend, (pivot[0], pivot[1]), lift)

    def _place(self, part: Part, begin: Vector, span: Vector) -> Vector:
        """In the frame of the link [m]."""
        point = part.point
        assert point is not None
        if point.place is None:
            return add(begin, (span[0] * point.fraction, span[1] * point.fraction, span[2] * point.fraction))
        x, y, z = (from_sympy(self.graph, e, self.e.free) for e in point.place)
        return self.e.drawn(part.joint, (x, y, z))

    def _lazy(self, part: Part) -> dict[sp.Symbol, Lazy]:
        """Variables that few laws use, made where they are needed."""
        x, n = part.variables, self._number(part)
        if isinstance(x, PointVariables | BodyVariables) or n is None:
            return {}
        if isinstance(x, InputVariables):
            return {x.input: lambda: self.graph.input("input", n)}

        def load() -> Expr:
            weight, drive = self.around.weight(n), self.e.drives[n]
            if weight is None:
                return self.graph.input("load", n)
            return weight * (drive.inverse_gain * drive.transmission.torque_constant)

        def gravity(axis: int) -> Lazy:
            return lambda: turn_z(self.e.frames[part.joint].theta, self._motions[part.joint].gravity)[axis]

        return {
            x.q: lambda: self.graph.input("q", n),
            x.load: load,
            x.time: lambda: self.graph.input("time", 0),
            **{symbol: gravity(axis) for axis, symbol in enumerate(x.gravity)},
        }
