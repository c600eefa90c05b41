"""An effect is one definition in SymPy, from which everything else is derived.

There are five kinds. An `Effect` is one generalised force over one coordinate, `LinkEffect` forces at
points of a link, `BodyEffect` those of a body that swings on a link, a `DescriptionEffect` changes what the
description says, an `InputEffect` stands between the input and the effort that comes of it. Forces are
positive where they oppose the input. They are linear in their linear parameters, whose columns of the
regressor are derivatives; all other parameters are fixed by the description. States advance by `step`.
What a diagnosis asks of an effect besides is in `Traits`; each kind sets what it implies.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import sympy as sp

from modelgen.description.objects import Arm
from modelgen.effects.parameters import ANY, POSITIVE, Parameter, Values, at
from modelgen.effects.traits import Numbers, Traits, joint_of
from modelgen.effects.variables import BodyVariables, InputVariables, PointVariables, Variables

__all__ = [
    "ANY",
    "POSITIVE",
    "BodyEffect",
    "Characteristic",
    "Definition",
    "DescriptionEffect",
    "Effect",
    "InputEffect",
    "LinkEffect",
    "Parameter",
    "Point",
    "Swing",
    "Values",
    "at",
]


@dataclass(frozen=True)
class Characteristic:
    """A law over a variable that no motion has. name, unit: of the variable, with {x} for that of the
    coordinate; reach: largest value that is drawn; force: over the variable.
    """

    variable: sp.Symbol
    name: str
    unit: str
    reach: float
    force: sp.Expr


class Definition(Traits):
    """One entry of the catalogue: what every kind of effect has.

    text: what it is, in a phrase; finding: the clause that says it is there, with {joint}, {drive} or
    {place} for where and values by their names, as {coefficient:%}, a joint's number as its name. scope:
    whether it stands at a "joint", at the "arm", or at "either". confused_with: effects that look alike in
    many records; experiment: what tells them apart. shown: values for the sketch of its law, in the units of
    the motor coordinates [rad, N m].
    """

    text: ClassVar[str]
    finding: ClassVar[str] = ""
    reference: ClassVar[str]
    scope: ClassVar[str] = "joint"
    side: ClassVar[str] = "joint"  # whose coordinate {x} and {f} are units of: "joint" or "motor"
    states: ClassVar[tuple[str, ...]] = ()
    confused_with: ClassVar[tuple[str, ...]] = ()
    experiment: ClassVar[str] = ""
    caveat: ClassVar[str] = ""  # what its values depend on besides the arm, a sentence after a blank
    seen_over: ClassVar[str] = "velocity"  # what shows it best: velocity, position, acceleration, load, time

    def values(self, given: Mapping[str, float]) -> dict[str, float]:
        """Nominal values of the linear parameters from the description's, where it gives them."""
        names = {parameter.name for parameter in self.linear}
        return {name: value for name, value in given.items() if name in names}

    def characteristic(self, p: Values) -> Characteristic | None:
        """Its law over a variable of its own; None for most, whose law is one over the arm's motion."""
        return None

    @classmethod
    def simulated(cls, values: Numbers) -> Mapping[str, float]:
        """What a simulator's joint may have that comes nearest to it; empty where nothing does.

        values: of all its parameters. The result is at its own coordinate x: forces that oppose the input,
        "damping" times v, "quadratic" times |v| v, "cubic" times v^3, "friction" times sign(v), "armature"
        times the acceleration, "stiffness" times x - "rest", "sine" and "cosine" times those of "wave" times
        x, and "force"; with "bristle", the distance over which "friction" builds up (Dahl 1968); or "lag"
        [s], the time constant by which the effort follows the input.
        """
        return {theirs: values[own] for theirs, own in cls.sources.items() if own in values}

    @classmethod
    def recognised(cls, properties: Numbers) -> Mapping[str, float]:
        """Values with which `simulated` gives just these properties; empty where none do."""
        if not cls.laws or set(properties) != set(cls.laws):
            return {}
        return {cls.laws[theirs]: value for theirs, value in properties.items()}

    @classmethod
    def held(cls, p: Mapping[str, sp.Expr | float]) -> tuple[str, ...]:
        """Names of the `states` that it has with these values of its parameters; all for most."""
        return cls.states


class Effect(Definition):
    """A generalised force over one coordinate: a law and its description, nothing else.

    place: "motor" or "joint", the coordinate of the drive or of the joint; "pair", the joint's coordinate
    and `ratio` times that of the joint `other`, both of them parameters; "transmission", where the law is
    the acceleration by which the link stays behind its drive, per coordinate [rad/s^2, m/s^2].
    """

    place: ClassVar[str] = "motor"
    side: ClassVar[str] = "motor"

    @classmethod
    def coupled(cls, values: Numbers) -> tuple[int, float] | None:
        """Return the other joint of a pair and the ratio."""
        return (round(values["other"]), values.get("ratio", 1.0)) if cls.place == "pair" else None

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
        """Points at which the force acts; a link of no length has no points of the line."""

    @abstractmethod
    def force(self, x: PointVariables, p: Values) -> sp.Matrix:
        """Force [N] that it takes to move the point against the effect, 3 x 1, in the axes of the frame."""

    def moment(self, x: PointVariables, p: Values) -> sp.Matrix:
        """Moment [N m] that it takes besides, 3 x 1, in the axes of the frame; zero for most."""
        return sp.zeros(3, 1)

    def masses(self, p: Values) -> Sequence[tuple[sp.Expr, Sequence[sp.Expr]]]:
        """Point masses [kg] and their places in the frame of the link [m] that do all that it does; none for
        most.
        """
        return ()

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

    @classmethod
    def vanishes(cls, estimated: Numbers) -> bool:
        """It shows by its weight alone where links and drive absorb its inertia, or noise hides it."""
        return False

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
    """A departure of the arm from its description: the model is that of the changed description.

    It follows from the arm's own equations; at one joint, it goes into the parameters that all share.
    """

    exact: ClassVar[bool] = True

    @classmethod
    def judged_at(cls, number: int | None, values: Numbers, n: int) -> list[int]:
        """All joints show what is wrong with one."""
        return list(range(n))

    @abstractmethod
    def changed(self, arm: Arm, joint: int | None, values: Mapping[str, float]) -> Arm:
        """The arm as it is; `joint` is an index into `arm.joints`. Raises ValueError with the reason."""


class InputEffect(Definition):
    """A change that the drive makes to its input, coordinate by coordinate, in the unit of the input."""

    needs_effort: ClassVar[bool] = True

    @classmethod
    def stands_at(cls, arm: Arm, number: int | None) -> bool:
        """It stands at a drive."""
        return number is None or joint_of(arm, number).drive.driven

    @abstractmethod
    def effective(self, x: InputVariables, p: Values) -> sp.Expr:
        """The input of an ideal drive with the same effort as this one's at x.input."""

    @abstractmethod
    def required(self, x: InputVariables, p: Values) -> sp.Expr:
        """The input that gives the effort of an ideal drive's x.input."""

    def step(self, x: InputVariables, p: Values, dt: sp.Symbol) -> Mapping[str, sp.Expr]:
        """The states after dt [s] at constant input."""
        return {}
