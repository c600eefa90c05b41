"""From the checked structure to the frozen objects: everything that pydantic cannot know is checked here."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from types import MappingProxyType

from modelgen.description.context import Context, show
from modelgen.description.document import Node, Path_
from modelgen.description.drives import read_drive, stroke_range, within_stroke
from modelgen.description.inertials import read_inertial
from modelgen.description.messages import describe, suggest
from modelgen.description.names import arm_name_problem, symbol_name_problem
from modelgen.description.objects import Arm, Drive, EffectUse, Inertial, Joint, Limits, NoDrive
from modelgen.description.schema import ArmModel, Document, JointModel, LeveredDriveModel

DEFAULT_EFFECTS = ("viscous_friction", "coulomb_friction", "drive_inertia")

KnownEffects = Mapping[str, Collection[str]]


def build(document: Document, root: Node, known_effects: KnownEffects | None) -> dict[str, Arm]:
    """All arms of the document, in its order. Raises InputError."""
    arms: dict[str, Arm] = {}
    folded: dict[str, str] = {}
    for name, model in document.arms.items():
        context = Context(root, name)
        problem = arm_name_problem(name)
        if problem:
            raise context.error(problem, [], key=True)
        other = folded.setdefault(name.lower(), name)
        if other != name:
            raise context.error(
                f"the files of the arms '{other}' and '{name}' would collide: the names differ in case alone",
                [],
                key=True,
            )
        arms[name] = _arm(context, model, known_effects)
    return arms


def _arm(context: Context, model: ArmModel, known_effects: KnownEffects | None) -> Arm:
    context.symbols = _symbols(context, model)
    names = _joint_names(context, model)
    antecedents = _antecedents(context, model, names)
    locked = _locked(context, model, names)
    joints = tuple(
        _joint(context, i, joint, antecedents[i], locked.get(joint.name), known_effects)
        for i, joint in enumerate(model.joints)
    )
    if not any(joint.moving for joint in joints):
        raise context.error("no joint of this arm moves, expected at least one revolute or prismatic one", ["joints"])
    density = context.number(model.fluid_density, "plain", ["fluid_density"])
    if density < 0.0:
        raise context.error(f"found {density:g} kg/m^3, expected a density that is not negative", ["fluid_density"])
    gravity = context.numbers(model.gravity, "plain", ["gravity"])
    return Arm(
        name=context.arm,
        joints=joints,
        links=_links(context, model, names),
        gravity=(gravity[0], gravity[1], gravity[2]),
        fluid_density=density,
        source=model.source,
        symbols=MappingProxyType(dict(context.symbols)),
        notes=tuple(context.notes),
        where=context.where([], key=True),
    )


def _symbols(context: Context, model: ArmModel) -> dict[str, float]:
    values: dict[str, float] = {}
    for name, raw in model.symbols.items():
        problem = symbol_name_problem(name)
        if problem:
            raise context.error(problem, ["symbols", name], key=True)
        values[name] = context.number(raw, "any", ["symbols", name])
    return values


def _joint_names(context: Context, model: ArmModel) -> list[str]:
    names: list[str] = []
    for i, joint in enumerate(model.joints):
        at = ["joints", i, "name"]
        if joint.name == "base":
            raise context.error("'base' names the arm's base, choose another name", at)
        if joint.name in names:
            raise context.error(f"a joint before is called '{joint.name}' as well, names must differ", at)
        names.append(joint.name)
    return names


def _antecedents(context: Context, model: ArmModel, names: list[str]) -> list[int | None]:
    antecedents: list[int | None] = []
    for i, joint in enumerate(model.joints):
        if joint.antecedent is None:
            antecedents.append(i - 1 if i else None)
        elif joint.antecedent == "base":
            antecedents.append(None)
        elif joint.antecedent in names:
            antecedents.append(names.index(joint.antecedent))
        else:
            hint = suggest(joint.antecedent, ["base", *names])
            at = ["joints", i, "antecedent"]
            raise context.error(f"found '{joint.antecedent}', which is no joint of this arm{hint}", at)
    for i in range(len(names)):
        chain = [i]
        while (parent := antecedents[chain[-1]]) is not None and parent not in chain:
            chain.append(parent)
        if parent is not None:
            loop = " <- ".join(names[k] for k in [*chain[chain.index(parent) :], parent])
            start = chain[chain.index(parent)]
            raise context.error(
                f"the antecedents form a cycle, {loop}; one of them must stand on the base",
                ["joints", start, "antecedent"],
            )
    return antecedents


def _locked(context: Context, model: ArmModel, names: list[str]) -> dict[str, float]:
    values: dict[str, float] = {}
    for name, raw in model.locked.items():
        at = ["locked", name]
        if name not in names:
            raise context.error(f"'{name}' is no joint of this arm{suggest(name, names)}", at, key=True)
        joint_type = model.joints[names.index(name)].type
        if joint_type == "fixed":
            raise context.error(f"'{name}' is a fixed joint, it has no coordinate to lock", at, key=True)
        values[name] = context.number(raw, _kind(joint_type), at)
    return values


def _kind(joint_type: str) -> str:
    return "length" if joint_type == "prismatic" else "angle"


def _joint(
    context: Context,
    i: int,
    model: JointModel,
    antecedent: int | None,
    locked: float | None,
    known_effects: KnownEffects | None,
) -> Joint:
    at: list[str | int] = ["joints", i]
    kind = _kind(model.type)

    alpha, theta, gamma = (
        context.quantity(raw, "angle", [*at, name]).scalar
        for name, raw in (("alpha", model.alpha), ("theta", model.theta), ("gamma", model.gamma))
    )
    d, r, b = (
        context.quantity(raw, "length", [*at, name]).scalar
        for name, raw in (("d", model.d), ("r", model.r), ("b", model.b))
    )
    drive = read_drive(context, model.drive, model.type, [*at, "drive"])
    limits = _limits(context, model, kind, at)
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


def _limits(context: Context, model: JointModel, kind: str, joint_at: Path_) -> Limits:
    given = model.limits
    at = [*joint_at, "limits"]
    position = None
    if model.type == "fixed" and given.model_fields_set:
        raise context.error("found limits on a fixed joint, expected none", at, key=True)
    if given.position is not None:
        low, high = context.numbers(given.position, kind, [*at, "position"])
        if low >= high:
            raise context.error(
                f"found {show(low, kind)} to {show(high, kind)}, expected the lower end first and a range above 0",
                [*at, "position"],
            )
        position = low, high
    if isinstance(model.drive, LeveredDriveModel):
        stroke = stroke_range(context, model.drive, [*joint_at, "drive"])
        position = within_stroke(context, model.name, position, stroke, [*at, "position"])
    return Limits(
        position=position,
        velocity=context.positive(given.velocity, kind, [*at, "velocity"]),
        acceleration=context.positive(given.acceleration, kind, [*at, "acceleration"]),
        effort=context.positive(given.effort, "plain", [*at, "effort"]),
    )


def _effects(
    context: Context, model: JointModel, drive: Drive, known_effects: KnownEffects | None, joint_at: Path_
) -> tuple[EffectUse, ...]:
    if model.effects is None:
        return () if isinstance(drive, NoDrive) else tuple(EffectUse(name) for name in DEFAULT_EFFECTS)
    at = [*joint_at, "effects"]
    if model.type == "fixed" and model.effects:
        raise context.error("found effects on a fixed joint, expected none", at, key=True)
    uses: list[EffectUse] = []
    for k, entry in enumerate(model.effects):
        named = isinstance(entry, str)
        name, raw = (entry, {}) if isinstance(entry, str) else next(iter(entry.items()))
        place: list[str | int] = [*at, k] if named else [*at, k, name]
        if known_effects is not None and name not in known_effects:
            raise context.error(f"there is no effect {describe(name)}{suggest(name, known_effects)}", place, key=True)
        if any(use.name == name for use in uses):
            raise context.error(f"the effect {describe(name)} is listed a second time on this joint", place, key=True)
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


def _links(context: Context, model: ArmModel, names: list[str]) -> tuple[Inertial | None, ...]:
    for name in model.links:
        if name not in names:
            raise context.error(f"'{name}' is no joint of this arm{suggest(name, names)}", ["links", name], key=True)
    return tuple(
        read_inertial(context, model.links[name], ["links", name]) if name in model.links else None for name in names
    )
