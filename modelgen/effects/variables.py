"""What the laws of effects may depend on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from modelgen.transmission import Transmission

Triple = tuple[sp.Symbol, sp.Symbol, sp.Symbol]


@dataclass(frozen=True)
class Variables:
    """Of a force over one coordinate.

    position, velocity, acceleration: of the coordinate that the effect belongs to. square: its velocity
    times that of the reference motion, velocity^2 where there is none. q: the joint's coordinate. load:
    force at the motor coordinate that the links' weight takes. transmitted: effort that moves the links
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
    transmitted: sp.Symbol
    inertia: sp.Symbol
    gravity: Triple
    time: sp.Symbol
    state: Mapping[str, sp.Symbol]
    transmission: Transmission


@dataclass(frozen=True)
class LinkVariables:
    """Of a wrench on a link, everything in the axes of its frame.

    spin [rad/s]; velocity of the origin [m/s]; spin_rate [rad/s^2]; acceleration of the origin less
    gravity, gravity [m/s^2]; end: of the link, where the next one begins [m].
    """

    spin: sp.Matrix
    velocity: sp.Matrix
    spin_rate: sp.Matrix
    acceleration: sp.Matrix
    gravity: sp.Matrix
    end: sp.Matrix

    def velocity_at(self, point: sp.Matrix) -> sp.Matrix:
        """Of a point of the link [m/s]."""
        return self.velocity + self.spin.cross(point)

    def acceleration_at(self, point: sp.Matrix) -> sp.Matrix:
        """Of a point of the link, less gravity [m/s^2]."""
        turning = self.spin_rate.cross(point) + self.spin.cross(self.spin.cross(point))
        return self.acceleration + turning


@dataclass(frozen=True)
class InputVariables:
    """Of what stands between input and effort: the input, the effect's states."""

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
        transmitted=symbol("transmitted"),
        inertia=symbol("inertia"),
        gravity=(symbol("gravity_x"), symbol("gravity_y"), symbol("gravity_z")),
        time=sp.Symbol("time", real=True),
        state=state_symbols(number, effect, states),
        transmission=drive,
    )


def link_variables(number: str) -> LinkVariables:
    """Variables with the link's number in their names."""
    names = ("spin", "velocity", "spin_rate", "acceleration", "gravity", "end")
    return LinkVariables(
        *(sp.Matrix([sp.Symbol(f"{name}_{axis}{number}", real=True) for axis in "xyz"]) for name in names)
    )


def state_symbols(number: str, effect: str, states: tuple[str, ...]) -> dict[str, sp.Symbol]:
    """Symbols of an effect's states."""
    return {name: sp.Symbol(f"{effect}_{name}_{number}", real=True) for name in states}
