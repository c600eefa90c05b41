"""Values that no arm has: friction that would drive, inertia below zero."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from modelgen.effects import CATALOGUE
from modelgen.identification.objects import DIAGNOSING, Estimate, Impossible, WorseThanNone

CLEARLY = 3.0  # standard deviations


def driving(estimates: Sequence[Estimate]) -> list[Estimate]:
    """Parameters of effects that are never negative, and come out below zero clearly.

    None of a joint at which another law of the same friction, by a power of the speed say, is above zero
    clearly: the two are alike in part, and it is their sum that brakes.
    """
    limited = {p.symbol for effect in CATALOGUE.values() for p in effect.linear if p.bounds[0] >= 0.0}
    varied = {p.symbol for effect in CATALOGUE.values() if effect.varies for p in effect.linear}
    sizes = [(e, e.name.rstrip("0123456789"), e.value / e.std) for e in estimates if e.std]
    braking = {e.joint for e, symbol, size in sizes if symbol in varied and size > CLEARLY}
    return [
        e
        for e, symbol, size in sizes
        if e.name == e.standard and symbol in limited and size < -CLEARLY and e.joint not in braking
    ]


def driven(
    estimates: Sequence[Estimate], joints: Sequence[str], *, signs_tried: bool = False
) -> list[Impossible]:
    """A question where parameters of effects that are never negative come out below zero clearly.

    joints: names of the coordinates. signs_tried: whether the other sign of the efforts was tried in vain.
    """
    negative = driving(estimates)
    if not negative:
        return []
    where = [joints[j - 1] for j in sorted({e.joint for e in negative})]
    asked = (
        f"The model lacks something there{DIAGNOSING}: the other sign of the efforts explains no more."
        if signs_tried
        else "Is the sign of the efforts the other way round, or that of torque_constant?"
    )
    text = (
        f"Impossible: {', '.join(e.name for e in negative)} below zero, which would drive "
        f"{', '.join(where)}. {asked}"
    )
    return [Impossible(text, where)]


def impossible_at(doubts: Iterable[str], joints: Sequence[str]) -> str:
    """The sentence that comes first where something was found that no arm has; empty where nothing was.

    joints: names of the coordinates.
    """
    asked = [doubt for doubt in doubts if isinstance(doubt, Impossible)]
    useless = {joint for doubt in asked if isinstance(doubt, WorseThanNone) for joint in doubt.joints}
    where = {joint for doubt in asked for joint in doubt.joints} - useless
    said = (("Physically impossible values", where), ("A prediction that is worse than none", useless))
    what = [
        f"{text} at {', '.join(name for name in joints if name in found)}" for text, found in said if found
    ]
    return f"{'; '.join(what)}: do not use the parameters before that is explained." if what else ""
