"""Laws of effects may depend on these variables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from modelgen.transmission import Transmission

Triple = tuple[sp.Symbol, sp.Symbol, sp.Symbol]


@dataclass(frozen=True)
class Variables:
    """Variables of a force over one coordinate.

    position, velocity, acceleration: of the coordinate that the effect belongs to. square: its velocity
    times that of the reference motion, velocity^2 where there is none. q: the joint's coordinate. load:
    force at the motor coordinate that the links' weight takes; carried: all that moves the links, where the
    parameters are known: in steps. transmitted: effort that moves the links
    as if they were rigid with their drives [N m, N]; inertia: of the links about the joint [kg m^2, kg].
    gravity: [m/s^2] in the axes of the joint's frame before it turns. time [s]; state: the effect's own.
    transmission: the joint's drive, over its symbol `q`.
    """

    position: sp.Symbol
    velocity: sp.Symbol
    acceleration: sp.Symbol
    square: sp.Symbol
    q: sp.Symbol
    load: sp.Symbol
    carried: sp.Symbol
    transmitted: sp.Symbol
    inertia: sp.Symbol
    gravity: Triple
    time: sp.Symbol
    state: Mapping[str, sp.Symbol]
    transmission: Transmission


@dataclass(frozen=True)
class PointVariables:
    """Variables of a force at a point of a link, in the axes of the link's frame.

    velocity [m/s]; acceleration less gravity, gravity [m/s^2]; line: direction of the link, from its origin
    to the next link's; turn: its derivative [1/s]; reference, reference_turn: velocity and turn of the
    reference motion, where one runs along (Slotine and Li 1987), else of the motion itself; length: of the
    line that the point stands for [m].
    """

    velocity: sp.Matrix
    turn: sp.Matrix
    reference: sp.Matrix
    reference_turn: sp.Matrix
    acceleration: sp.Matrix
    gravity: sp.Matrix
    line: sp.Matrix
    length: sp.Symbol

    def along(self, v: sp.Matrix) -> sp.Expr:
        """The part of a vector along the line of the link."""
        return v.dot(self.line)

    def across(self, v: sp.Matrix) -> sp.Matrix:
        """The part of a vector across the line of the link."""
        return v - self.line * self.along(v)


@dataclass(frozen=True)
class BodyVariables:
    """Variables of a body that turns against the link that carries it, in its own axes.

    pivot: acceleration of its pivot less gravity, gravity [m/s^2]; along, across: accelerations of what lies
    1 m from the pivot on its x and its y axis, less the pivot's. q: the coordinate that turns it;
    transmission: its drive, over its symbol `q`.
    """

    pivot: sp.Matrix
    along: sp.Matrix
    across: sp.Matrix
    gravity: sp.Matrix
    q: sp.Symbol
    transmission: Transmission


@dataclass(frozen=True)
class InputVariables:
    """Variables between input and effort: the input, the effect's states."""

    input: sp.Symbol
    state: Mapping[str, sp.Symbol]


def joint_variables(number: str, effect: str, states: tuple[str, ...], drive: Transmission) -> Variables:
    """Variables with the joint's number in their names."""

    def symbol(name: str) -> sp.Symbol:
        return sp.Symbol(f"{name}{number}", real=True)

    return Variables(
        position=symbol("position"),
        velocity=symbol("velocity"),
        acceleration=symbol("acceleration"),
        square=symbol("square"),
        q=symbol("q"),
        load=symbol("load"),
        carried=symbol("carried"),
        transmitted=symbol("transmitted"),
        inertia=symbol("inertia"),
        gravity=(symbol("gravity_x"), symbol("gravity_y"), symbol("gravity_z")),
        time=sp.Symbol("time", real=True),
        state=state_symbols(number, effect, states),
        transmission=drive,
    )


def _point_variables() -> PointVariables:
    """Variables at any point of any link, with names that no symbol of a description can have."""

    def triple(name: str) -> sp.Matrix:
        return sp.Matrix([sp.Symbol(f"{name}_{axis} of the point", real=True) for axis in "xyz"])

    return PointVariables(
        velocity=triple("velocity"),
        turn=triple("turn"),
        reference=triple("reference"),
        reference_turn=triple("reference_turn"),
        acceleration=triple("acceleration"),
        gravity=triple("gravity"),
        line=triple("line"),
        length=sp.Symbol("length of the point", positive=True),
    )


def body_variables(number: str, drive: Transmission) -> BodyVariables:
    """Variables with the joint's number in their names."""

    def triple(name: str) -> sp.Matrix:
        return sp.Matrix([sp.Symbol(f"{name}_{axis}{number}", real=True) for axis in "xyz"])

    return BodyVariables(
        pivot=triple("pivot"),
        along=triple("along"),
        across=triple("across"),
        gravity=triple("gravity"),
        q=sp.Symbol(f"q{number}", real=True),
        transmission=drive,
    )


def state_symbols(number: str, effect: str, states: tuple[str, ...]) -> dict[str, sp.Symbol]:
    """Symbols of an effect's states."""
    return {name: sp.Symbol(f"{effect}_{name}_{number}", real=True) for name in states}


POINT = _point_variables()
