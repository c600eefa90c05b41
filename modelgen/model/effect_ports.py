"""Ports of effects in an arm's graph give all that their laws may depend on."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property

import sympy as sp

from modelgen.effects import (
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
from modelgen.model.screws import PartialVelocities, Screw

Lazy = Callable[[], Expr]


def number(e: Equations, part: Part) -> int | None:
    """Coordinate of the part's joint."""
    coordinates = e.arm.coordinates
    return coordinates.index(part.joint) if part.joint in coordinates else None


class Ports:
    """Ports of the effects at the motion `rates`, with what is known of the links around them."""

    def __init__(self, equations: Equations, rates: Rates, around: Surroundings) -> None:
        self.e, self.graph, self.rates, self.around = equations, equations.graph, rates, around
        self._made: dict[int, tuple[Part, Port]] = {}  # by the place of a part, which stays, in memory

    def converted(self, part: Part, expression: sp.Expr, known: Mapping[sp.Symbol, Expr]) -> Expr:
        """An expression in the graph, the joint's sine and cosine as they are elsewhere."""
        x = part.variables
        if not isinstance(x, Variables | BodyVariables):
            return from_sympy(self.graph, expression, known)
        n = number(self.e, part)
        assert n is not None
        return from_sympy(
            self.graph, expression, known, lambda angle: self.e.trigonometry.lookup(n, x.q, angle)
        )

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

    @cached_property
    def _screws(self) -> list[dict[int, Screw]]:
        return PartialVelocities(self.e.frames).of_link

    def of(self, effect: AppliedEffect, part: Part) -> Port:
        """Place at which one part of an effect acts; effects at an input have none."""
        if id(part) not in self._made:
            self._made[id(part)] = part, self._port(effect, part)
        return self._made[id(part)][1]

    def _port(self, effect: AppliedEffect, part: Part) -> Port:
        x = part.variables
        if isinstance(x, PointVariables):
            return self._point_port(x, part)
        if isinstance(x, BodyVariables):
            return body_port(self.e.frames, self._swinging(x, part), self.rates, self._motions, x)
        assert isinstance(x, Variables)
        n = number(self.e, part)
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
        return Port(point_rows(self._screws[i], place), bound, tuple(x.acceleration))

    def _swinging(self, x: BodyVariables, part: Part) -> Swinging:
        n, swing = number(self.e, part), part.swing
        assert n is not None
        assert swing is not None
        known = {**self.e.scalars.symbols, **self.e.free, x.q: self.graph.input("q", n)}
        parts = (swing.cosine, swing.sine, swing.turn, swing.bend, *swing.pivot)
        cosine, sine, turn, bend, *pivot = (self.converted(part, e, known) for e in parts)
        lift = self.e.scalars(self.e.arm.joints[part.joint].lift)
        return Swinging(part.joint, cosine, sine, turn, bend, (pivot[0], pivot[1]), lift)

    def _place(self, part: Part, begin: Vector, span: Vector) -> Vector:
        """Read a place in the frame of the link [m]."""
        point = part.point
        assert point is not None
        if point.place is None:
            return add(begin, (span[0] * point.fraction, span[1] * point.fraction, span[2] * point.fraction))
        x, y, z = (from_sympy(self.graph, e, self.e.free) for e in point.place)
        return self.e.drawn(part.joint, (x, y, z))

    def lazy(self, part: Part) -> dict[sp.Symbol, Lazy]:
        """Variables that few laws use, made where they are needed."""
        x, n = part.variables, number(self.e, part)
        if isinstance(x, PointVariables | BodyVariables) or n is None:
            return {}
        if isinstance(x, InputVariables):
            return {x.input: lambda: self.graph.input("input", n)}

        def at_motor(effort: Expr) -> Expr:
            drive = self.e.drives[n]
            return effort * (drive.inverse_gain * drive.transmission.torque_constant)

        def load() -> Expr:
            weight = self.around.weight(n)
            return self.graph.input("load", n) if weight is None else at_motor(weight)

        def carried() -> Expr:
            effort = self.around.transmitted(n)
            assert effort is not None, "steps know the parameters"
            return at_motor(effort)

        def gravity(axis: int) -> Lazy:
            return lambda: turn_z(self.e.frames[part.joint].theta, self._motions[part.joint].gravity)[axis]

        return {
            x.q: lambda: self.graph.input("q", n),
            x.load: load,
            x.carried: carried,
            x.time: lambda: self.graph.input("time", 0),
            **{symbol: gravity(axis) for axis, symbol in enumerate(x.gravity)},
        }
