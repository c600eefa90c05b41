"""All effects by name, and the effects of an arm."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches

import sympy as sp

from modelgen.description.objects import Arm, EffectUse
from modelgen.effects.base import Effect, Parameter, Variables
from modelgen.effects.friction import (
    CoulombFriction,
    FrictionOffset,
    StribeckFriction,
    ViscousFriction,
)
from modelgen.effects.mechanism import DriveInertia, Spring
from modelgen.errors import InputError

CATALOGUE: dict[str, type[Effect]] = {
    effect.name: effect
    for effect in (ViscousFriction, CoulombFriction, FrictionOffset, StribeckFriction, DriveInertia, Spring)
}


def known_effects() -> dict[str, tuple[str, ...]]:
    """Names of the parameters that a description may set, by effect."""
    return {name: tuple(p.name for p in effect.accepted()) for name, effect in CATALOGUE.items()}


@dataclass(frozen=True)
class AppliedEffect:
    """One effect at one joint, its law with symbols for the linear parameters.

    `joint` is an index into `arm.joints`, `coordinate` the number of its coordinate. `parameters` are
    (Parameter, symbol) of the linear ones; nonlinear ones are numbers in the law already.
    """

    effect: Effect
    joint: int
    coordinate: int
    variables: Variables
    parameters: tuple[tuple[Parameter, sp.Symbol], ...]
    law: sp.Expr
    potential: sp.Expr
    steps: Mapping[str, sp.Expr]
    nominal: Mapping[str, float]

    @property
    def side(self) -> str:
        """The coordinate that the effect belongs to: "motor" or "joint"."""
        return self.effect.side


TIME_STEP = sp.Symbol("dt", positive=True)


def applied_effects(arm: Arm) -> list[AppliedEffect]:
    """The effects of the arm's moving joints, joint after joint.

    Raises InputError for an unknown effect, an unknown or missing value, or one out of bounds.
    """
    result = []
    for coordinate, index in enumerate(arm.coordinates):
        seen: set[str] = set()
        for use in arm.joints[index].effects:
            if use.name in seen:
                raise InputError(
                    f"effect {use.name} stands twice at joint {arm.joints[index].name}", use.where
                )
            seen.add(use.name)
            result.append(_applied(use, index, coordinate))
    return result


def _applied(use: EffectUse, index: int, coordinate: int) -> AppliedEffect:
    effect = effect_class(use)()
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
    number = f"{index + 1}"
    position, velocity, acceleration = (
        sp.Symbol(f"{kind}{number}", real=True) for kind in ("position", "velocity", "acceleration")
    )
    x = Variables(
        position,
        velocity,
        acceleration,
        sp.Symbol("time", real=True),
        {name: sp.Symbol(f"{use.name}_{name}_{number}", real=True) for name in effect.states},
    )
    parameters = tuple((p, sp.Symbol(f"{p.symbol}{number}", real=True)) for p in effect.linear)
    values: dict[str, sp.Expr] = {p.name: symbol for p, symbol in parameters}
    for p in effect.nonlinear:
        given = {p.name: p.default, **use.values}[p.name]
        if given is None:
            raise InputError(f"{use.name} needs a value for {p.name} [{p.unit}]: {p.text}", use.where)
        values[p.name] = sp.Integer(int(given)) if given == int(given) else sp.Float(given)
    return AppliedEffect(
        effect,
        index,
        coordinate,
        x,
        parameters,
        effect.law(x, values),
        effect.potential(x, values),
        effect.step(x, values, TIME_STEP),
        effect.values(use.values),
    )


def effect_class(use: EffectUse) -> type[Effect]:
    """The catalogue's class; raises InputError with the nearest name."""
    if use.name not in CATALOGUE:
        raise InputError(
            f"unknown effect {use.name}{_hint(use.name, CATALOGUE)}; available: {', '.join(CATALOGUE)}",
            use.where,
        )
    return CATALOGUE[use.name]


def _hint(name: str, known: Mapping[str, object]) -> str:
    close = get_close_matches(name, known, 1)
    return f", did you mean {close[0]}?" if close else ""
