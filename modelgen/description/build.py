"""The checked structure becomes frozen objects; everything that pydantic cannot know is checked here."""

from __future__ import annotations

from types import MappingProxyType

from modelgen.description.context import Context
from modelgen.description.document import Node
from modelgen.description.inertials import read_inertial
from modelgen.description.joints import KnownEffects, coordinate_kind, read_effects, read_joint
from modelgen.description.messages import describe
from modelgen.description.names import arm_name_problem, symbol_name_problem
from modelgen.description.objects import Arm, Combined, Inertial, Watched
from modelgen.description.plausible import ask_gravity, ask_unit
from modelgen.description.schema import ArmModel, Document
from modelgen.description.transforms import read_base, read_tools
from modelgen.errors import suggest


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
        read_joint(context, i, joint, antecedents[i], locked.get(joint.name), known_effects)
        for i, joint in enumerate(model.joints)
    )
    if not any(joint.moving for joint in joints):
        raise context.error("no joint of this arm moves, expected at least one that does", ["joints"])
    density = context.number(model.fluid_density, "plain", ["fluid_density"])
    if density < 0.0:
        raise context.error(f"found {density:g} kg/m^3, expected 0 or more", ["fluid_density"])
    gravity = context.numbers(model.gravity, "plain", ["gravity"])
    ask_gravity(context, gravity, ["gravity"])
    return Arm(
        name=context.arm,
        joints=joints,
        links=_links(context, model, names),
        gravity=(gravity[0], gravity[1], gravity[2]),
        fluid_density=density,
        source=model.source,
        version=model.version,
        symbols=MappingProxyType(dict(context.symbols)),
        notes=tuple(context.notes),
        effects=read_effects(context, model.effects, known_effects, ["effects"], "arm"),
        base=read_base(context, model),
        tools=read_tools(context, model, names),
        combined=_combined(context, model),
        monitor=tuple(Watched(name, context.where(["monitor", i])) for i, name in enumerate(model.monitor)),
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


def _combined(context: Context, model: ArmModel) -> tuple[Combined, ...]:
    """Whether the functions exist is known where these are made."""
    found = []
    for name, functions in model.combined.items():
        places = tuple(context.where(["combined", name, i]) for i in range(len(functions)))
        at = context.where(["combined", name], key=True)
        found.append(Combined(name, tuple(functions), at, places))
    return tuple(found)


def _joint_names(context: Context, model: ArmModel) -> list[str]:
    names: list[str] = []
    for i, joint in enumerate(model.joints):
        at: list[str | int] = ["joints", i, "name"]
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
            message = f"found '{joint.antecedent}', which is no joint of this arm{hint}"
            raise context.error(message, ["joints", i, "antecedent"])
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
            raise context.error(
                f"{describe(name)} is no joint of this arm{suggest(name, names)}", at, key=True
            )
        joint_type = model.joints[names.index(name)].type
        if joint_type == "fixed":
            raise context.error(f"'{name}' is a fixed joint, it has no coordinate to lock", at, key=True)
        kind = coordinate_kind(joint_type)
        values[name] = context.number(raw, kind, at)
        ask_unit(context, raw, "length" if kind == "length" else "range", at)
    return values


def _links(context: Context, model: ArmModel, names: list[str]) -> tuple[Inertial | None, ...]:
    for name in model.links:
        if name not in names:
            message = f"{describe(name)} is no joint of this arm{suggest(name, names)}"
            raise context.error(message, ["links", name], key=True)
    return tuple(
        read_inertial(context, model.links[name], ["links", name]) if name in model.links else None
        for name in names
    )
