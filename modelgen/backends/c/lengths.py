"""Lengths of arrays in prototypes, by the size macros of the header: compilers warn of shorter ones."""

from __future__ import annotations

from collections.abc import Sequence
from math import prod

from modelgen.backends.c.dialect import arrays
from modelgen.functions.objects import Argument, Function, Model, Output
from modelgen.functions.steps import OF_EFFECTS, STATE

_SINGLE = ("dt", "time", "forgetting", "kinetic", "potential")
Factors = Sequence[tuple[str, int]]


def argument_length(model: Model, function: Function, argument: Argument) -> str:
    """Length of an input, in print."""
    if argument.length:
        return _printed(model, [(argument.length, argument.size)], argument.size)
    known = {
        "parameters": _parameters(model, function),
        STATE: ("N_STATES", len(model.states)),
        OF_EFFECTS: ("N_STATES", len(model.states)),
        "geometry": ("N_GEOMETRY", len(model.geometry)),
    }
    single = argument.name in _SINGLE
    factor = ("", 1) if single else known.get(argument.name, _joints(model))
    return _printed(model, [factor], argument.size)


def array_lengths(model: Model, function: Function) -> dict[str, str]:
    """Lengths of the output arrays, in print, by their names."""
    lengths = arrays(function)
    if function.stacked:
        links = ("N_LINKS", len(model.arm.joints))
        return {name: _printed(model, [("16", 16), links], size) for name, size in lengths.items()}
    named = zip(lengths.items(), function.outputs, strict=True)
    return {name: _printed(model, _shape(model, function, o), size) for (name, size), o in named}


def _shape(model: Model, function: Function, output: Output) -> Factors:
    joints = _joints(model)
    if output.length:
        return [(output.length, output.size)]
    if output.name in _SINGLE:
        return [("", 1)]
    if output.name == "state_next":
        return [("N_STATES", len(model.states))]
    if output.name == "jacobian":
        return [("6", 6), joints]
    if output.name == "matrix" and output.columns == 1:
        return [("N_PACKED", len(model.packed.rows))]
    if output.columns == 1:
        return [joints]
    return [joints, _parameters(model, function) if output.name == "matrix" else joints]


def _joints(model: Model) -> tuple[str, int]:
    return "N_JOINTS", len(model.arm.coordinates)


def _parameters(model: Model, function: Function) -> tuple[str, int]:
    if function.name.endswith("_standard"):
        return "N_STANDARD_PARAMETERS", len(model.standard)
    return "N_PARAMETERS", len(model.grouping.base)


def _printed(model: Model, factors: Factors, size: int) -> str:
    """The product of the factors where it is the size, else the number; nothing of a size of 0."""
    if size == 0:
        return ""
    if prod(value for _, value in factors) != size or not all(text for text, _ in factors):
        return str(size)
    macro = model.arm.name.upper()
    return " * ".join(text if text.isdigit() else f"{macro}_{text}" for text, _ in factors)
