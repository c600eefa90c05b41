"""What an effect is: one definition in SymPy, from which everything else is derived.

There are five kinds. An `Effect` is one generalised force over one coordinate, `LinkEffect` forces at
points of a link, `BodyEffect` those of a body that swings on a link, a `DescriptionEffect` changes what the
description says, an `InputEffect` stands between the input and the effort that comes of it. Forces are
positive where they oppose the input. They are linear in their linear parameters, whose columns of the
regressor are derivatives; all other parameters are fixed by the description. States advance by `step`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar

import sympy as sp

from modelgen.description.objects import Arm
from modelgen.effects.variables import BodyVariables, InputVariables, PointVariables, Variables

Values = Mapping[str, sp.Expr]  # of an effect's parameters, by name
ANY = (-float("inf"), float("inf"))
POSITIVE = (1e-12, float("inf"))


@dataclass(frozen=True)
class Parameter:
    """A parameter of an effect.

    unit: {f} stands for the unit of the generalised force, {x} for that of the coordinate. symbol: its
    name among the standard parameters, before the joint's number (linear parameters only). default:
    None where the description must give a value for a nonlinear parameter. bounds: sensible values.
    grid: where a diagnosis begins to look for the value of a nonlinear parameter, in units of `scale`:
    "speed" (95 % of the coordinate's speeds are below), "span" (of the coordinate), "time" (the record's
    length), "stiffness" (largest effort over the span) or "1". turns: an angle, whose grid goes once round
    in equal steps, above zero; a value less a turn is the same.
    """

    name: str
    unit: str
    text: str
    symbol: str = ""
    default: float | None = None
    bounds: tuple[float, float] = (0.0, float("inf"))
    scale: str = "1"
    grid: tuple[float, ...] = ()
    turns: bool = False


def at(**values: float) -> Mapping[str, float]:
    """Values of parameters by name, for `Definition.shown`."""
    return MappingProxyType(values)


class Definition(ABC):
    """One entry of the catalogue: what every kind of effect has.

    scope: whether it stands at a "joint", at the "arm", or at "either". confused_with: effects that
    look alike in many records; experiment: what tells them apart. shown: values for its picture in
    docs/effects.md, in the units of the motor coordinates [rad, N m].
    """

    name: ClassVar[str]
    text: ClassVar[str]
    reference: ClassVar[str]
    scope: ClassVar[str] = "joint"
    side: ClassVar[str] = "joint"  # whose coordinate {x} and {f} are units of: "joint" or "motor"
    linear: ClassVar[tuple[Parameter, ...]] = ()
    nonlinear: ClassVar[tuple[Parameter, ...]] = ()
    states: ClassVar[tuple[str, ...]] = ()
    confused_with: ClassVar[tuple[str, ...]] = ()
    experiment: ClassVar[str] = ""
    shown: ClassVar[Mapping[str, float]] = at()
    seen_over: ClassVar[str] = "velocity"  # what shows it best: velocity, position, acceleration or time

    def values(self, given: Mapping[str, float]) -> dict[str, float]:
        """Nominal values of the linear parameters from the description's, where it gives them."""
        names = {parameter.name for parameter in self.linear}
        return {name: value for name, value in given.items() if name in names}

    @classmethod
    def held(cls, p: Mapping[str, sp.Expr | float]) -> tuple[str, ...]:
        """Of `states`, those that it has with these values of its parameters; all for most."""
        return cls.states

    @classmethod
    def accepted(cls) -> tuple[Parameter, ...]:
        """The parameters that a description may set."""
        return (*cls.linear, *cls.nonlinear)


class Effect(Definition):
    """A generalised force over one coordinate: a law and its description, nothing else.

    place: "motor" or "joint", the coordinate of the drive or of the joint; "pair", the joint's coordinate
    and `ratio` times that of the joint `other`, both of them parameters; "transmission", where the law is
    the acceleration by which the link stays behind its drive, per coordinate [rad/s^2, m/s^2].
    """

    place: ClassVar[str] = "motor"
    side: ClassVar[str] = "motor"

    @abstractmethod
    def law(self, x: Variables, p: Values) -> sp.Expr:
        """Generalised force for the parameters `p`, by name."""

    def beside(self, x: Variables, p: Values) -> sp.Expr:
        """Effort at the joint besides, by position and states alone; zero for most."""
        return sp.Integer(0)

    def step(self, x: Variables, p: Values, dt: sp.Symbol) -> Mapping[str, sp.Expr]:
        """The states after dt [s] at constant velocity; every name of `states`."""
        return {}

    def potential(self, x: Variables, p: Values) -> sp.Expr:
        """Energy stored [J], up to a constant; zero for what is not conservative."""
        return sp.Integer(0)

    def __init_subclass__(cls) -> None:
        """`side` alone may be given: the place is then that coordinate."""
        if "side" in cls.__dict__ and "place" not in cls.__dict__:
            cls.place = cls.side
        elif "place" in cls.__dict__ and "side" not in cls.__dict__:
            cls.side = "motor" if cls.place == "motor" else "joint"


@dataclass(frozen=True)
class Point:
    """A point of a link: at a place in its frame [m], or at a fraction of its line, for a part of that."""

    place: tuple[sp.Expr, sp.Expr, sp.Expr] | None = None
    fraction: float = 0.0
    part: float = 0.0


class LinkEffect(Definition):
    """Forces at points of a link."""

    scope: ClassVar[str] = "either"

    @abstractmethod
    def points(self, p: Values) -> Sequence[Point]:
        """Where the force acts; points of the line do not exist on a link of no length."""

    @abstractmethod
    def force(self, x: PointVariables, p: Values) -> sp.Matrix:
        """Force [N] that it takes to move the point against the effect, 3 x 1, in the axes of the frame."""

    def moment(self, x: PointVariables, p: Values) -> sp.Matrix:
        """Moment [N m] that it takes besides, 3 x 1, in the axes of the frame; zero for most."""
        return sp.zeros(3, 1)

    def links(self, arm: Arm, joint: int | None) -> list[int]:
        """Indices of the links it acts on: the joint's own, all of them for the whole arm."""
        return [joint] if joint is not None else list(range(len(arm.joints)))


@dataclass(frozen=True)
class Swing:
    """How a body turns with a coordinate q about the direction of its joint.

    cosine, sine: of its angle against the joint's frame before that turns; turn, bend: first and second
    derivative of the angle by q; pivot: x and y in that frame [m].
    """

    cosine: sp.Expr
    sine: sp.Expr
    turn: sp.Expr
    bend: sp.Expr
    pivot: tuple[sp.Expr, sp.Expr]


class BodyEffect(Definition):
    """A body that the link before the joint carries, and that the joint turns against it."""

    @abstractmethod
    def swing(self, x: BodyVariables, p: Values) -> Swing:
        """How it turns, over `x.q`. Raises ValueError where the joint's drive moves no such body."""

    @abstractmethod
    def force(self, x: BodyVariables, p: Values) -> tuple[sp.Matrix, sp.Matrix, sp.Matrix]:
        """Forces [N], 3 x 1 each, that it takes to accelerate its pivot, and what lies 1 m from that on its
        x and its y axis as it moves against the pivot.
        """

    @abstractmethod
    def potential(self, x: BodyVariables, p: Values) -> sp.Expr:
        """Energy stored [J], up to a constant."""


class DescriptionEffect(Definition):
    """A departure of the arm from its description: the model is that of the changed description."""

    @abstractmethod
    def changed(self, arm: Arm, joint: int | None, values: Mapping[str, float]) -> Arm:
        """The arm as it is; `joint` is an index into `arm.joints`. Raises ValueError with the reason."""


class InputEffect(Definition):
    """What the drive makes of its input, coordinate by coordinate, in the unit of the input."""

    @abstractmethod
    def effective(self, x: InputVariables, p: Values) -> sp.Expr:
        """The input of an ideal drive with the same effort as this one's at x.input."""

    @abstractmethod
    def required(self, x: InputVariables, p: Values) -> sp.Expr:
        """The input that gives the effort of an ideal drive's x.input."""

    def step(self, x: InputVariables, p: Values, dt: sp.Symbol) -> Mapping[str, sp.Expr]:
        """The states after dt [s] at constant input."""
        return {}
