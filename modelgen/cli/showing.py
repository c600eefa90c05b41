"""modelgen show: base parameters, their grouping, and what the functions cost."""

from __future__ import annotations

from typing import Any

import typer

from modelgen.base_parameters import BaseParameter, for_reading
from modelgen.cli.generating import total
from modelgen.cli.output import print_json, print_table
from modelgen.description import Arm
from modelgen.functions import Model, Options, build_model


def run(arm: Arm, options: Options, *, as_json: bool) -> None:
    """Build the arm's model and print it. Raises InputError."""
    model = build_model(arm, options)
    if as_json:
        print_json(data(model))
    else:
        _print(model)


def data(model: Model) -> dict[str, Any]:
    """The model as plain data."""
    arm = model.arm
    return {
        "arm": arm.name,
        "joints": len(arm.coordinates),
        "coordinates": [arm.joints[i].name for i in arm.coordinates],
        "standard_parameters": [p.name for p in model.standard],
        "base_parameters": [
            {"name": p.name, "expression": p.expression, "unit": p.unit} for p in model.grouping.base
        ],
        "without_effect": [model.standard[i].name for i in model.grouping.without_effect],
        "functions": {f.name: dict(f.operations) for f in model.functions},
        "notes": [*arm.notes, *model.remarks],
    }


def _print(model: Model) -> None:
    arm = model.arm
    names = [arm.joints[i].name for i in arm.coordinates]
    typer.echo(f"{arm.name}: {len(names)} joint{'s' if len(names) > 1 else ''} ({', '.join(names)})")
    if arm.source:
        typer.echo(f"source: {' '.join(arm.source.split())}")
    for note in (*arm.notes, *model.remarks):
        typer.echo(f"note: {note}")
    print_table(
        f"{len(model.standard)} standard parameters, {len(model.grouping.base)} base parameters",
        {"": "right", "base parameter": "left", "unit": "left"},
        [[str(i), _equation(p), p.unit] for i, p in enumerate(model.grouping.base)],
    )
    without = [model.standard[i].name for i in model.grouping.without_effect]
    if without:
        print_table("without effect on the input", {"standard parameters": "left"}, [[", ".join(without)]])
    kinds = ("mul", "add", "neg", "div", "sqrt", "trig", "other")
    print_table(
        "operations",
        {"function": "left", "mul+add+neg": "right", **dict.fromkeys(kinds, "right")},
        [
            [f.name, str(total(f.operations)), *(str(f.operations.get(kind, 0)) for kind in kinds)]
            for f in model.functions
        ],
    )


def _equation(parameter: BaseParameter) -> str:
    """MX2R = MX2 + d3 (M3 + M4), or the name alone where it stands for itself."""
    if parameter.expression == parameter.name:
        return parameter.name
    return f"{parameter.name} = {for_reading(parameter.expression)}"
