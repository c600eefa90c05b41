"""Where an effect can stand, and the arm that has it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from modelgen.description import Arm
from modelgen.description.objects import EffectUse
from modelgen.effects import CATALOGUE, DescriptionEffect, InputEffect
from modelgen.effects.laws.environment import AddedMass, FluidDrag
from modelgen.effects.laws.measurement import LeverGeometry
from modelgen.effects.laws.mechanism import ActuatorMass

# effect, number of the coordinate from 1 or None for the whole arm, values of its parameters
Found = tuple[str, int | None, Mapping[str, float]]
_LEVERS = (LeverGeometry, ActuatorMass)


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


def places(arm: Arm, name: str) -> list[int | None]:
    """Numbers of the coordinates (from 1) at which the effect can stand and does not yet; None: the arm.

    An effect that may stand at either is offered for the whole arm.
    """
    effect = CATALOGUE[name]
    if name == "time_delay":
        return _of_delay(arm)
    if effect.scope != "joint":
        there = any(use.name == name for use in arm.effects)
        if issubclass(effect, FluidDrag | AddedMass) and not _tips_known(arm):
            return []
        return [] if there else [None]
    found: list[int | None] = []
    for number, index in enumerate(arm.coordinates, 1):
        joint = arm.joints[index]
        if any(use.name == name for use in joint.effects):
            continue
        if issubclass(effect, _LEVERS) and joint.drive.actuator is None:
            continue
        driven = joint.drive.driven
        if name == "drive_gain_error" and not driven:
            continue
        if issubclass(effect, InputEffect) and not driven:
            continue
        if name == "transmission_coupling" and len(arm.coordinates) < 2:
            continue
        found.append(number)
    return found


def _of_delay(arm: Arm) -> list[int | None]:
    """Of one driven joint's input, or of all."""
    if any(use.name == "time_delay" for use in arm.effects):
        return []
    found: list[int | None] = [None]
    for number, index in enumerate(arm.coordinates, 1):
        joint = arm.joints[index]
        there = any(use.name == "time_delay" for use in joint.effects)
        if joint.drive.driven and not there:
            found.append(number)
    return found if len(found) != 2 else [None]


def _tips_known(arm: Arm) -> bool:
    """Whether the links that carry no other have nominal inertials, from which their end is taken."""
    carrying = {joint.antecedent for joint in arm.joints}
    return all(link is not None for i, link in enumerate(arm.links) if i not in carrying)


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


def changes_description(name: str) -> bool:
    """Whether the effect is a departure of the arm from its description."""
    return issubclass(CATALOGUE[name], DescriptionEffect)
