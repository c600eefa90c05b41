"""Equations of an arm with one effect alone, whose values are left free."""

from __future__ import annotations

from collections.abc import Mapping

from modelgen.base_parameters.rules import slid
from modelgen.description.objects import Arm
from modelgen.effects import CATALOGUE, Definition
from modelgen.effects.placement import with_effect
from modelgen.model.equations import Equations

Values = Mapping[str, float]


class Alone:
    """Of every effect at every place the equations of the arm with it alone, made when they are asked for."""

    def __init__(self, arm: Arm) -> None:
        self._arm = arm.without_effects()
        self._made: dict[tuple[str, int | None, tuple[tuple[str, float], ...]], Equations] = {}

    def __call__(self, effect: str, joint: int | None, values: Values) -> Equations:
        """Equations of the arm with this effect, what is not fixed left free."""
        definition: type[Definition] = CATALOGUE[effect]
        free = tuple(p.name for p in definition.nonlinear if not p.structural)
        fixed = {p.name: values[p.name] for p in definition.nonlinear if p.structural and p.name in values}
        key = (effect, joint, tuple(sorted(fixed.items())))
        if key not in self._made:
            alone = with_effect(self._arm, effect, joint, fixed)
            self._made[key] = Equations(slid(alone), free=free, lazy=True)
        return self._made[key]


def free_values(e: Equations, values: Values) -> tuple[float, ...]:
    """Values of what was left free, in the order of the equations. Raises ValueError where one is missing."""
    defaults = {p.name: p.default for effect in e.effects for p in effect.effect.nonlinear}
    names = [symbol.name.removeprefix("free_") for symbol in e.free]
    given = [values.get(name, defaults[name]) for name in names]
    missing = [name for name, value in zip(names, given, strict=True) if value is None]
    if missing:
        raise ValueError(f"no value for {', '.join(missing)}")
    return tuple(float(value) for value in given if value is not None)
