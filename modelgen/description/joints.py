"""One joint of the description: frame, limits, drive and effects."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from types import MappingProxyType
from typing import TypeAlias

from modelgen.description.context import Context, show
from modelgen.description.document import Steps
from modelgen.description.drives import read_drive, within_reach
from modelgen.description.messages import describe
from modelgen.description.objects import EffectUse, Joint, Limits
from modelgen.description.plausible import ask_unit
from modelgen.description.schema import EffectEntry, JointModel
from modelgen.errors import suggest
from modelgen.resources import default_effects
from modelgen.transmission import Drive

DEFAULT_EFFECTS = default_effects()

KnownEffects: TypeAlias = Mapping[str, Collection[str]]


def coordinate_kind(joint_type: str) -> str:
    """Whether a joint's coordinate is an "angle" or a "length"."""
    return "length" if joint_type == "prismatic" else "angle"


def read_joint(
    context: Context,
    i: int,
    model: JointModel,
    antecedent: int | None,
    locked: float | None,
    known_effects: KnownEffects | None,
) -> Joint:
    """Joint number i of the arm; `antecedent` and `locked` have been resolved. Raises InputError."""
    at: list[str | int] = ["joints", i]
    kind = coordinate_kind(model.type)

    alpha, theta, gamma = (
        context.quantity(raw, "angle", [*at, name]).scalar
        for name, raw in (("alpha", model.alpha), ("theta", model.theta), ("gamma", model.gamma))
    )
    d, r, b = (
        context.quantity(raw, "length", [*at, name]).scalar
        for name, raw in (("d", model.d), ("r", model.r), ("b", model.b))
    )
    for name, raw in (("alpha", model.alpha), ("theta", model.theta), ("gamma", model.gamma)):
        ask_unit(context, raw, "angle", [*at, name])
    for name, raw in (("d", model.d), ("r", model.r), ("b", model.b)):
        ask_unit(context, raw, "length", [*at, name])
    drive = read_drive(context, model.drive, model.type, [*at, "drive"])
    limits = _limits(context, model, drive, kind, at)
    effects = _effects(context, model, drive, known_effects, at)
    if locked is not None:
        if limits.position and not limits.position[0] <= locked <= limits.position[1]:
            low, high = (show(value, kind) for value in limits.position)
            raise context.error(
                f"found {show(locked, kind)}, which lies outside the joint's range {low} to {high}",
                ["locked", model.name],
            )
        effects = ()
    return Joint(
        name=model.name,
        type=model.type,
        alpha=alpha,
        d=d,
        r=r,
        theta=theta,
        gamma=gamma,
        b=b,
        antecedent=antecedent,
        limits=limits,
        drive=drive,
        effects=effects,
        locked=locked,
        where=context.where(at),
    )


def _limits(context: Context, model: JointModel, drive: Drive, kind: str, joint_at: Steps) -> Limits:
    given = model.limits
    at = [*joint_at, "limits"]
    position = None
    if model.type == "fixed" and given.model_fields_set:
        raise context.error("found limits on a fixed joint, expected none", at, key=True)
    if given.position is not None:
        low, high = context.numbers(given.position, kind, [*at, "position"])
        for k, raw in enumerate(given.position):
            ask_unit(context, raw, "length" if kind == "length" else "range", [*at, "position", k])
        if low >= high:
            raise context.error(
                f"found {show(low, kind)} to {show(high, kind)}, expected the lower end first",
                [*at, "position"],
            )
        position = low, high
    position = within_reach(context, model.name, position, drive, kind, [*at, "position"])
    return Limits(
        position=position,
        velocity=context.positive(given.velocity, kind, [*at, "velocity"]),
        acceleration=context.positive(given.acceleration, kind, [*at, "acceleration"]),
        effort=context.positive(given.effort, "plain", [*at, "effort"]),
    )


def _effects(
    context: Context, model: JointModel, drive: Drive, known_effects: KnownEffects | None, joint_at: Steps
) -> tuple[EffectUse, ...]:
    if model.effects is None:
        return tuple(EffectUse(name) for name in DEFAULT_EFFECTS) if drive.driven else ()
    at = [*joint_at, "effects"]
    if model.type == "fixed" and model.effects:
        raise context.error("found effects on a fixed joint, expected none", at, key=True)
    return read_effects(context, model.effects, known_effects, at, "joint")


def read_effects(
    context: Context,
    entries: list[EffectEntry],
    known_effects: KnownEffects | None,
    at: Steps,
    owner: str,
) -> tuple[EffectUse, ...]:
    """The list of effects at `at`, of a "joint" or of the "arm". Raises InputError."""
    uses: list[EffectUse] = []
    for k, entry in enumerate(entries):
        named = isinstance(entry, str)
        name, raw = (entry, {}) if isinstance(entry, str) else next(iter(entry.items()))
        place: list[str | int] = [*at, k] if named else [*at, k, name]
        if known_effects is not None and name not in known_effects:
            message = f"there is no effect {describe(name)}{suggest(name, known_effects)}"
            raise context.error(message, place, key=True)
        if any(use.name == name for use in uses):
            raise context.error(
                f"the effect {describe(name)} is listed twice on this {owner}", place, key=True
            )
        values: dict[str, float] = {}
        for parameter, value in raw.items():
            if known_effects is not None and parameter not in known_effects[name]:
                hint = suggest(parameter, known_effects[name])
                raise context.error(
                    f"{name} has no parameter {describe(parameter)}{hint}", [*place, parameter], key=True
                )
            values[parameter] = context.number(value, "any", [*place, parameter])
        uses.append(EffectUse(name, MappingProxyType(values), context.where(place, key=True)))
    return tuple(uses)
