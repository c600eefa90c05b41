"""README of an arm: functions, units, shapes, operations, an example."""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.backends.c.dialect import arrays, destinations
from modelgen.backends.documentation import unit
from modelgen.backends.elements import coordinates
from modelgen.backends.provenance import Provenance
from modelgen.backends.text import plain, render, wrapped
from modelgen.functions.objects import Argument, Function, Model, Output


def readme(model: Model, provenance: Provenance, sizes: Sequence[Sequence[str]] = ()) -> str:
    """The text. `sizes`: rows of a table of flash, stack and instructions, its heading first."""
    arm = model.arm.name
    functions = [
        [f"`{f.name}`", _inputs(f), _outputs(f), _cost(f), plain(f.text)]
        for f in model.functions
        if not f.name.endswith("_standard") or not _has_twin(model, f)
    ]
    rows = [[str(i), c.name, c.unit, c.text] for i, c in enumerate(coordinates(model))]
    return render(
        "readme.md.j2",
        arm=arm,
        macro=arm.upper(),
        provenance=provenance.head(arm),
        real=provenance.real,
        other="float" if provenance.real == "double" else "double",
        summary=wrapped(plain(model.arm.source) or f"Dynamic model of the arm {arm}.").split("\n"),
        coordinates=_table(["", "joint", "unit", ""], rows),
        functions=_table(["function", "inputs", "outputs", "operations", "meaning"], functions),
        standard=len(model.standard),
        base=len(model.grouping.base),
        sizes=_table(sizes[0], sizes[1:]) if sizes else [],
        example=_example(model),
    )


def _has_twin(model: Model, function: Function) -> bool:
    return any(f.name == function.name.removesuffix("_standard") for f in model.functions)


def _table(heading: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    lines = [heading, ["---"] * len(heading), *rows]
    return ["| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines]


def _inputs(function: Function) -> str:
    return ", ".join(f"{a.name}[{a.size}]" + _of(a) for a in function.arguments)


def _of(item: Argument | Output) -> str:
    """The unit, where there is one for all elements."""
    return f" {unit(item.unit)}" if item.unit and not item.unit.startswith("see ") else ""


def _outputs(function: Function) -> str:
    shapes = []
    for output in function.outputs:
        shape = f"{output.rows}" if output.columns == 1 else f"{output.rows} × {output.columns}"
        shapes.append(f"{output.name}: {shape}{_of(output)}")
    if len(shapes) > 2 and function.stacked:
        return f"{len(shapes)} in a row, each {shapes[0].partition(': ')[2]}"
    return ", ".join(shapes)


def _cost(function: Function) -> str:
    counts = function.operations
    text = str(sum(counts[kind] for kind in ("mul", "add", "neg")))
    rest = [f"{counts[kind]} {kind}" for kind in ("div", "sqrt", "trig", "other") if counts.get(kind)]
    return ", ".join([text, *rest])


def _example(model: Model) -> list[str]:
    """A call of the first function."""
    arm = model.arm.name
    function = model.functions[0]
    lines = [f'#include "{arm}.h"', ""]
    for a in function.arguments:
        lines.append(f"{arm}_real_t {a.name}[{a.size}] = {{0}};{_comment(a)}")
    lines += [f"{arm}_real_t {name}[{size}];" for name, size in arrays(function).items()]
    names = [a.name for a in function.arguments] + list(arrays(function))
    places = sorted({place for place, _ in destinations(function).values()})
    lines += [
        "",
        f"if ({arm}_{function.name}({', '.join(names)}) != {arm.upper()}_STATUS_OK) {{",
        f"    /* {' and '.join(places)}: all zero */",
        "}",
    ]
    return lines


def _comment(argument: Argument) -> str:
    return f" /*{_of(argument)} */" if _of(argument) else f" /* {plain(argument.text)} */"
