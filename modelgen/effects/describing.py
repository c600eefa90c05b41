"""The arm as its effects on the description make it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from modelgen.description.objects import Arm, EffectUse
from modelgen.effects.applied import effect_class, resolved, uses
from modelgen.effects.base import DescriptionEffect
from modelgen.errors import InputError


def described(arm: Arm) -> Arm:
    """The arm with its effects on the description carried out and taken off its lists.

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
