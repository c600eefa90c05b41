"""The effects of an arm: each use in the description with its law over symbols of its own."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TypeAlias

import sympy as sp

from modelgen.description.objects import Arm, EffectUse, Joint
from modelgen.effects.base import (
    BodyEffect,
    Definition,
    DescriptionEffect,
    Effect,
    InputEffect,
    LinkEffect,
    Parameter,
    Point,
    Swing,
    Values,
)
from modelgen.effects.catalogue import CATALOGUE, unit_text
from modelgen.effects.variables import (
    POINT,
    BodyVariables,
    InputVariables,
    PointVariables,
    Variables,
    body_variables,
    joint_variables,
    state_symbols,
)
from modelgen.errors import InputError, nearest
from modelgen.transmission import of_joint

TIME_STEP = sp.Symbol("dt", positive=True)
Given: TypeAlias = tuple[tuple[str, sp.Expr], ...]  # values by name


@dataclass(frozen=True)
class Part:
    """One part of an effect: its place and its force there.

    place: that of the `Effect`, "point", "body" or "input". joint: index into `arm.joints`. forces: one, for
    a point x, y, z in the axes of its link, and its moment likewise where there is one; for a body those of
    `BodyEffect.force`, one after the other; for an input the required and the effective one.
    """

    place: str
    joint: int
    variables: Variables | PointVariables | BodyVariables | InputVariables
    forces: tuple[sp.Expr, ...]
    point: Point | None = None
    swing: Swing | None = None


@dataclass(frozen=True)
class AppliedEffect:
    """One effect at one joint, or at the whole arm (`joint` None).

    `joint` is an index into `arm.joints`. parameters: (Parameter, symbol) of the linear ones. values: all
    parameters by name, the linear ones their symbols, the others numbers (or symbols where left free).
    """

    effect: Definition
    joint: int | None
    parameters: tuple[tuple[Parameter, sp.Symbol], ...]
    values: Values
    parts: tuple[Part, ...]
    potential: sp.Expr
    states: Mapping[str, sp.Symbol]
    steps: Mapping[str, sp.Expr]
    nominal: Mapping[str, float]

    @property
    def side(self) -> str:
        """The coordinate whose units its parameters have: "motor" or "joint"."""
        return self.effect.side

    @property
    def elastic(self) -> bool:
        """Whether it lies between a drive and its link, which then lags."""
        return any(part.place == "transmission" for part in self.parts)

    @property
    def constant(self) -> bool:
        """Whether it adds a force that no parameter scales, as a payload of known mass does."""
        return not self.parameters and all(p.place not in ("input", "transmission") for p in self.parts)

    def depends_on(self, name: str) -> bool:
        """Whether forces or steps use the variable `name` of `Variables`."""
        for part in self.parts:
            symbol = getattr(part.variables, name, None)
            if symbol is not None and any(e.has(symbol) for e in (*part.forces, *self.steps.values())):
                return True
        return False


def applied_effects(arm: Arm, free: Collection[str] = ()) -> list[AppliedEffect]:
    """The effects of the arm's moving joints, joint after joint, then those of the whole arm.

    Nonlinear parameters named in `free` stay symbols. Effects on the description are not among them
    (see `described`). Raises InputError for an unknown effect, an effect at the wrong place or twice, an
    unknown or missing value, or one out of bounds.
    """
    result = []
    for use, joint in uses(arm):
        effect = effect_class(use)()
        if not isinstance(effect, DescriptionEffect):
            result += _applied(arm, effect, use, joint, free)
    return result


def uses(arm: Arm) -> list[tuple[EffectUse, int | None]]:
    """Every use of an effect with the index of its joint; InputError for one that cannot stand there."""
    found: list[tuple[EffectUse, int | None]] = []
    places = [(arm.joints[i].effects, i, f"at joint {arm.joints[i].name}") for i in arm.coordinates]
    for entries, joint, place in [*places, (arm.effects, None, "at the arm")]:
        names: set[str] = set()
        for use in entries:
            scope = effect_class(use).scope
            if use.name in names:
                raise InputError(f"effect {use.name} stands twice {place}", use.where)
            if scope == "arm" and joint is not None:
                raise InputError(
                    f"{use.name} acts on the whole arm, expected under `effects` of the arm", use.where
                )
            if scope == "joint" and joint is None:
                raise InputError(f"{use.name} acts on one joint, expected under its `effects`", use.where)
            names.add(use.name)
            found.append((use, joint))
    return found


def resolved(effect: Definition, use: EffectUse) -> dict[str, float]:
    """Values of the nonlinear parameters; InputError for one unknown, missing or out of bounds."""
    allowed = {p.name: p for p in effect.accepted()}
    for name, value in use.values.items():
        if name not in allowed:
            raise InputError(
                f"{use.name} has no parameter {name}{_hint(name, allowed)}; it has {', '.join(allowed)}",
                use.where,
            )
        low, high = allowed[name].bounds
        if not low <= value <= high:
            raise InputError(f"{use.name}: {name} is {value}, expected {low} to {high}", use.where)
    values = {}
    for p in effect.nonlinear:
        given = {p.name: p.default, **use.values}[p.name]
        if given is None:
            raise InputError(
                f"{use.name} needs a value for {p.name} [{unit_text(type(effect), p)}]: {p.text}", use.where
            )
        values[p.name] = given
    return values


def _applied(
    arm: Arm, effect: Definition, use: EffectUse, joint: int | None, free: Collection[str]
) -> list[AppliedEffect]:
    numbers = resolved(effect, EffectUse(use.name, {**dict.fromkeys(free, 1.0), **use.values}, use.where))
    number = "" if joint is None else f"{joint + 1}"
    parameters = tuple((p, sp.Symbol(f"{p.symbol}{number}", real=True)) for p in effect.linear)
    values: dict[str, sp.Expr] = {p.name: symbol for p, symbol in parameters}
    for name, value in numbers.items():
        exact = sp.Integer(int(value)) if value == int(value) else sp.Float(value)
        values[name] = free_symbol(name) if name in free else exact
    nominal = effect.values(use.values)
    if isinstance(effect, InputEffect):
        joints = list(arm.coordinates) if joint is None else [joint]
        own = tuple(values.items())
        laws = [(i, *_at_input(type(effect), i, own)) for i in joints]
        return [
            AppliedEffect(effect, i, (), values, (part,), sp.Integer(0), states, steps, nominal)
            for i, part, states, steps in laws
        ]
    states: Mapping[str, sp.Symbol] = {}
    steps: Mapping[str, sp.Expr] = {}
    potential: sp.Expr = sp.Integer(0)
    if isinstance(effect, LinkEffect):
        own = tuple(values.items())
        parts = tuple(part for i in effect.links(arm, joint) for part in _on_link(type(effect), i, own))
    elif isinstance(effect, BodyEffect):
        assert joint is not None
        body = body_variables(number, of_joint(arm, arm.joints[joint]))
        try:
            swing = effect.swing(body, values)
        except ValueError as error:
            raise InputError(f"{use.name}: {error}", use.where) from None
        forces = tuple(f for force in effect.force(body, values) for f in force)
        parts, potential = (Part("body", joint, body, forces, swing=swing),), effect.potential(body, values)
    else:
        assert isinstance(effect, Effect)
        assert joint is not None
        x = joint_variables(number, effect.name, effect.held(values), of_joint(arm, arm.joints[joint]))
        try:
            parts = (Part(effect.place, joint, x, (effect.law(x, values),)),)
            beside = effect.beside(x, values)
            if beside != 0:
                parts += (Part("joint", joint, x, (beside,)),)
        except ValueError as error:
            raise InputError(f"{use.name}: {error}", use.where) from None
        states, steps = x.state, effect.step(x, values, TIME_STEP)
        potential = effect.potential(x, values)
    if "other" in numbers and int(numbers["other"]) not in _others(arm, joint):
        choice = ", ".join(str(k) for k in _others(arm, joint))
        raise InputError(f"{use.name}: other is {numbers['other']:g}, expected one of {choice}", use.where)
    return [AppliedEffect(effect, joint, parameters, values, parts, potential, states, steps, nominal)]


def _others(arm: Arm, joint: int | None) -> list[int]:
    """Numbers of the arm's coordinates but that of the joint."""
    return [n for n, i in enumerate(arm.coordinates, 1) if i != joint]


def free_symbol(name: str) -> sp.Symbol:
    """The symbol of a nonlinear parameter that is left free."""
    return sp.Symbol(f"free_{name}", real=True)


# A law over symbols is the same for every arm, and at each point of each link: only the port of a part knows
# what its symbols are. A diagnosis asks for each many times.
@lru_cache(maxsize=1024)
def _on_link(effect: type[LinkEffect], link: int, given: Given) -> tuple[Part, ...]:
    forces = _at_point(effect, given)
    return tuple(Part("point", link, POINT, forces, point) for point in effect().points(dict(given)))


@lru_cache(maxsize=256)
def _at_point(effect: type[LinkEffect], given: Given) -> tuple[sp.Expr, ...]:
    values = dict(given)
    moment = effect().moment(POINT, values)
    return (*effect().force(POINT, values), *(moment if any(m != 0 for m in moment) else []))


@lru_cache(maxsize=1024)
def _at_input(
    effect: type[InputEffect], joint: int, given: Given
) -> tuple[Part, Mapping[str, sp.Symbol], Mapping[str, sp.Expr]]:
    """Its part, its states and their steps."""
    number, values = f"{joint + 1}", dict(given)
    states = state_symbols(number, effect.name, effect.states)
    x = InputVariables(sp.Symbol(f"input{number}", real=True), states)
    part = Part("input", joint, x, (effect().required(x, values), effect().effective(x, values)))
    return part, states, effect().step(x, values, TIME_STEP)


def effect_class(use: EffectUse) -> type[Definition]:
    """The catalogue's class; raises InputError with the nearest name."""
    if use.name not in CATALOGUE:
        raise InputError(
            f"unknown effect {use.name}{_hint(use.name, CATALOGUE)}; available: {', '.join(CATALOGUE)}",
            use.where,
        )
    return CATALOGUE[use.name]


def pivot_direction(joint: Joint) -> float | None:
    """Direction [rad] that the joint's effects give its actuator's base, as in `Traits`; None for most.

    Raises InputError as `effect_class` does.
    """
    found = (effect_class(use).pivot_direction(use.values) for use in joint.effects)
    return next((angle for angle in found if angle is not None), None)


def _hint(name: str, known: Mapping[str, object]) -> str:
    near = nearest(name, known)
    return f", did you mean {near}?" if near else ""


def described(arm: Arm) -> Arm:
    """The arm with its effects on the description carried out and off its lists.

    Raises InputError for values that the arm does not admit, and as `applied_effects` does.
    """
    changed = arm
    for use, joint in uses(arm):
        effect = effect_class(use)()
        if isinstance(effect, DescriptionEffect):
            try:
                changed = effect.changed(changed, joint, resolved(effect, use))
            except ValueError as error:
                raise InputError(f"{use.name}: {error}", use.where) from None
    joints = tuple(replace(joint, effects=_kept(joint.effects)) for joint in changed.joints)
    return replace(changed, joints=joints, effects=_kept(arm.effects))


def _kept(entries: Sequence[EffectUse]) -> tuple[EffectUse, ...]:
    return tuple(use for use in entries if not issubclass(effect_class(use), DescriptionEffect))
