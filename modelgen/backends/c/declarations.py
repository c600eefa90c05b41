"""Header of an arm: sizes, names of the parameters, prototypes and what they mean."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from modelgen.backends.c.batch import BATCH, batches
from modelgen.backends.c.dialect import arrays, destinations, literal
from modelgen.backends.c.lengths import argument_length, array_lengths
from modelgen.backends.c.levels import levels
from modelgen.backends.c.strokes import strokes, wrappers
from modelgen.backends.documentation import (
    argument_row,
    function_operations,
    model_sections,
    output_text,
    remarks,
    unit,
)
from modelgen.backends.elements import base_parameters, standard_parameters
from modelgen.backends.text import plain, table, wrapped
from modelgen.functions.objects import Function, Model
from modelgen.transmission import of_joint

_ONE_LINE = 1000  # the comment of an enumerator is not wrapped


@dataclass(frozen=True)
class FunctionText:
    """A function's prototype and documentation, ready for the templates."""

    name: str
    summary: tuple[str, ...]
    parameters: tuple[str, ...]  # lines of Doxygen
    operations: str
    signature: str


def function_text(model: Model, function: Function) -> FunctionText:
    """The texts of one function."""
    arm = model.arm.name
    real = f"{arm}_real_t"
    rows = [("@param[in]", *argument_row(model, function, a)) for a in function.arguments]
    places = destinations(function)
    lengths = arrays(function)
    for output in function.outputs:
        array, offset = places[output.name]
        if lengths[array] == output.size:
            rows.append(("@param[out]", array, f"[{output.size}]", unit(output.unit), output_text(output)))
        else:
            if offset == 0:
                rows.append(("@param[out]", array, f"[{lengths[array]}]", "", "one after the other:"))
            span = f"{array}[{offset}] to [{offset + output.size - 1}]"
            text = f"{span}: {output.name}, {output_text(output)}"
            rows.append(("", "", "", unit(output.unit), text))
    declared = [f"const {real} {a.name}[{argument_length(model, function, a)}]" for a in function.arguments]
    declared += [f"{real} {name}[{length}]" for name, length in array_lengths(model, function).items()]
    arguments = ",\n".join(f"    {argument}" for argument in declared)
    return FunctionText(
        name=function.name,
        summary=tuple(wrapped(plain(function.text), width=100).split("\n")),
        parameters=tuple(table(rows)),
        operations=function_operations(function),
        signature=f"{arm}_status_t {arm}_{function.name}(\n{arguments})",
    )


@dataclass(frozen=True)
class ParameterCheck:
    """A vector of parameters checked alone: suffix, prototype, meaning, length, bound squared."""

    suffix: str
    signature: str
    text: str
    size: int
    limit: str


def parameter_checks(model: Model) -> list[ParameterCheck]:
    """A check for each vector of parameters that a function takes. Raises ValueError as `literal` does."""
    arm = model.arm.name
    found: dict[str, ParameterCheck] = {}
    for function in model.functions:
        for a in function.arguments:
            suffix = "_standard" if function.name.endswith("_standard") else ""
            if a.name == "parameters" and a.size and suffix not in found:
                length = argument_length(model, function, a)
                signature = (
                    f"{arm}_status_t {arm}_check_parameters{suffix}(const {arm}_real_t parameters[{length}])"
                )
                limit = literal(arm, a.bound * a.bound)
                found[suffix] = ParameterCheck(suffix, signature, a.text, a.size, limit)
    return list(found.values())


def header_values(model: Model, functions: list[FunctionText]) -> dict[str, object]:
    """Values that the template of the header needs beside the names."""
    macro = model.arm.name.upper()
    sizes = [
        ("N_JOINTS", len(model.arm.coordinates), "coordinates"),
        ("N_LINKS", len(model.arm.joints), "links, those behind locked and fixed joints included"),
        ("N_PARAMETERS", len(model.grouping.base), "base parameters"),
        ("N_STANDARD_PARAMETERS", len(model.standard), "standard parameters"),
    ]
    packed = any(function.name == "regressor_packed" for function in model.functions)
    if packed:
        sizes.append(("N_PACKED", len(model.packed.rows), "structural non-zeros of the regressor"))
    if model.geometry:
        sizes.append(("N_GEOMETRY", len(model.geometry), "lengths and angles given at run time"))
    if model.states:
        sizes.append(("N_STATES", len(model.states), "states of the effects"))
    of_steps = {a.length: a for function in model.functions for a in function.arguments if a.length}
    sizes += [(length, a.size, plain(a.text)) for length, a in of_steps.items()]
    return {
        "remarks": remarks(model),
        "gravity": ", ".join(f"{value:g}" for value in model.arm.gravity),
        "sections": model_sections(model),
        "sizes": [
            row.rstrip()
            for row in table(
                (f"#define {macro}_{name}", str(size), f"/**< {text} */") for name, size, text in sizes
            )
        ],
        "parameters": _indices(macro, "PARAMETER", ((p.name, unit(p.unit)) for p in base_parameters(model))),
        "standard": _indices(
            macro,
            "STANDARD",
            ((p.name, f"{unit(p.unit)} {plain(p.text)}") for p in standard_parameters(model)),
        ),
        "packed": packed,
        "nominal": bool(model.nominal),
        "linked": _linked(model),
        "functions": functions,
        "levels": levels(model),
        "batches": batches(model),
        "strokes": strokes(model),
        "wrappers": wrappers(model),
        "motor_unit": _motor_unit(model),
    }


def _motor_unit(model: Model) -> str:
    """What `unit` stands for, where a motor coordinate may be in any."""
    driven = (of_joint(model.arm, model.arm.joints[i]) for i in model.arm.coordinates)
    if any(t.driven and t.unit == "unit" for t in driven):
        return "; `unit` is that of a motor coordinate in the description, increments say"
    return ""


def _linked(model: Model) -> list[str]:
    """Names with external linkage."""
    suffixes = [check.suffix for check in parameter_checks(model)]
    names = [function.name for function in model.functions]
    names += [*(f"check_parameters{suffix}" for suffix in suffixes), "model", "sincos"]
    if model.levels is not None:
        names += ["observer_gain", "observer_threshold", "observer_alarms"]
        names += ["monitor_alarms"] if model.levels.start else []
    names += [stroke.name for stroke in strokes(model)]
    names += [f"{name}{BATCH}" for name in model.batch]
    if "regressor_packed" in names:
        names += ["regressor_rows", "regressor_columns"]
    if model.nominal:
        names.append("nominal_parameters")
    return [f"{model.arm.name}_{name}" for name in names]


def _indices(macro: str, kind: str, rows: Iterable[tuple[str, str]]) -> list[str]:
    """Enumerators in the order of the rows (name, comment)."""
    named = [(re.sub(r"\W", "_", name, flags=re.ASCII), comment) for name, comment in rows]
    last = len(named) - 1
    return table(
        (
            (f"{macro}_{kind}_{name} = {i}{',' if i < last else ''}", f"/**< {comment} */")
            for i, (name, comment) in enumerate(named)
        ),
        width=_ONE_LINE,
    )
