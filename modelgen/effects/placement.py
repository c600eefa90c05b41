"""Placement says where an effect can stand, and makes the arm that has it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

from modelgen.description import Arm
from modelgen.description.objects import EffectUse
from modelgen.effects import CATALOGUE

# effect, number of the coordinate from 1 or None for the whole arm, values of its parameters
Found = tuple[str, int | None, Mapping[str, float]]


def extended_arm(arm: Arm, causes: Sequence[Found]) -> Arm:
    """The arm with the causes' effects; values of those that it has are replaced."""
    for effect, joint, values in causes:
        arm = with_effect(arm, effect, joint, admitted(effect, values))
    return arm


def admitted(effect: str, values: Mapping[str, float]) -> dict[str, float]:
    """Values that the description may hold: of a linear parameter none outside its bounds."""
    definition = CATALOGUE[effect]
    linear = {p.name for p in definition.linear}
    found = {}
    for p in definition.accepted():
        if p.name in values and (p.name not in linear or p.bounds[0] <= values[p.name] <= p.bounds[1]):
            found[p.name] = float(f"{values[p.name]:.9g}")
    return found


def titled(
    arm: Arm, effect: str, joint: int | None, values: Mapping[str, float] = MappingProxyType({})
) -> str:
    """An effect and where it acts, as people read it.

    joint: a coordinate from 1, None for the whole arm. values: of its parameters, of which some may be the
    numbers of further joints that it has to do with.
    """
    place = "of the whole arm" if joint is None else f"at {arm.coordinate_names[joint - 1]}"
    others = [joint_meant(arm, effect, name, value) for name, value in values.items()]
    return " and ".join([f"{effect} {place}", *(name for name in others if name)])


def joint_meant(arm: Arm, effect: str, parameter: str, value: float) -> str:
    """Name of the joint whose number the parameter's value is; empty where the parameter is none."""
    joints = {p.name for p in CATALOGUE[effect].accepted() if p.joint}
    return arm.coordinate_names[round(value) - 1] if parameter in joints else ""


def places(arm: Arm, name: str) -> list[int | None]:
    """Numbers of the coordinates (from 1) at which the effect can stand and does not yet; None: the arm.

    One that may stand at either is offered for the whole arm, or for the others where some joints have it;
    each alone too where each has a size of its own, as links of different thickness have.
    """
    effect = CATALOGUE[name]
    everywhere = any(use.name == name for use in arm.effects)
    whole: list[int | None] = [None] if not everywhere and effect.stands_at(arm, None) else []
    alone: list[int | None] = [
        number
        for number, index in enumerate(arm.coordinates, 1)
        if all(use.name != name for use in arm.joints[index].effects) and effect.stands_at(arm, number)
    ]
    some = any(use.name == name for index in arm.coordinates for use in arm.joints[index].effects)
    if effect.scope == "joint" or some:
        return alone
    return [*whole, *alone] if whole and effect.own_sizes and len(alone) != 1 else whole


def with_effect(arm: Arm, name: str, joint: int | None, values: Mapping[str, float]) -> Arm:
    """The arm with one effect more, at coordinate number `joint` (from 1) or at the whole arm.

    Where the effect stands there already, its values are replaced.
    """
    use = EffectUse(name, dict(values))
    if joint is None:
        return replace(arm, effects=_with(arm.effects, use))
    index = arm.coordinates[joint - 1]
    old = arm.joints[index]
    new = replace(old, effects=_with(old.effects, use))
    return replace(arm, joints=tuple(new if i == index else j for i, j in enumerate(arm.joints)))


def _with(uses: Sequence[EffectUse], use: EffectUse) -> tuple[EffectUse, ...]:
    if all(u.name != use.name for u in uses):
        return (*uses, use)
    return tuple(use if u.name == use.name else u for u in uses)
