"""Names of the elements of a function's inputs, and which of them the code names."""

from __future__ import annotations

import re
from dataclasses import dataclass

from modelgen.functions.objects import Argument, Function, Model
from modelgen.functions.steps import OF_EFFECTS, STATE

# Names of parameters are short and carry the number of their joint, so they never meet those of a library.
_NAME = re.compile(r"[A-Z]+[0-9]+[A-Za-z0-9_]*")


@dataclass(frozen=True)
class Element:
    """One element of an input: its name, its unit and what it means."""

    name: str
    unit: str
    text: str


def coordinates(model: Model) -> tuple[Element, ...]:
    """The coordinates q of an arm."""
    return tuple(
        Element(joint.name, joint.unit, f"{joint.type}, {joint.drive.title}")
        for joint in (model.arm.joints[i] for i in model.arm.coordinates)
    )


def base_parameters(model: Model) -> tuple[Element, ...]:
    """The base parameters, with the combinations that they stand for."""
    return tuple(Element(p.name, p.unit, p.expression) for p in model.grouping.base)


def standard_parameters(model: Model) -> tuple[Element, ...]:
    """The standard parameters, with their meaning."""
    return tuple(Element(p.name, p.unit, p.text) for p in model.standard)


def elements(model: Model, function: Function, argument: Argument) -> tuple[Element, ...]:
    """The elements of an argument where they differ in meaning, else nothing.

    Raises ValueError where the argument has another length than what it stands for.
    """
    if argument.elements:
        found = tuple(Element(name, "", "") for name in argument.elements)
    elif argument.length:
        return ()
    elif argument.name == "parameters":
        found = standard_parameters(model) if function.name.endswith("_standard") else base_parameters(model)
    elif argument.name == "geometry":
        found = tuple(
            Element(name, "", f"{model.arm.symbols[name]!r} in the description") for name in model.geometry
        )
    elif argument.name in (STATE, OF_EFFECTS):
        found = tuple(Element(name, "", "") for name in model.states)
    else:
        return ()
    if len(found) != argument.size:
        raise ValueError(
            f"{model.arm.name}: {function.name} takes {argument.size} {argument.name}, "
            f"the model has {len(found)}"
        )
    return found


def local_names(model: Model, function: Function) -> dict[str, tuple[Element | None, ...]]:
    """Elements that the code reads under a name of their own, by argument; None for the others."""
    taken = {output.name for output in function.outputs}
    result = {}
    for argument in function.arguments:
        named: list[Element | None] = []
        for element in elements(model, function, argument):
            free = element.name not in taken and _NAME.fullmatch(element.name) is not None
            taken.add(element.name)
            named.append(element if free else None)
        result[argument.name] = tuple(named)
    return result
