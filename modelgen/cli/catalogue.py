"""modelgen effects: the catalogue in print."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import typer

from modelgen.cli.output import print_json, print_table
from modelgen.effects import CATALOGUE, Definition, Parameter


def run(*, as_json: bool) -> None:
    """Print every effect with its parameters."""
    if as_json:
        print_json([_data(effect) for effect in CATALOGUE.values()])
        return
    rows = []
    for effect in CATALOGUE.values():
        for i, parameter in enumerate(effect.accepted()):
            head = [effect.name, effect.side] if i == 0 else ["", ""]
            rows.append([*head, parameter.name, _unit(parameter), _bounds(parameter), parameter.text])
    columns = dict.fromkeys(("effect", "side", "parameter", "unit", "bounds", "meaning"), "left")
    print_table("", columns, rows)
    typer.echo("side: the coordinate x that the effect belongs to, of the motor or of the joint.")
    typer.echo("units: x is that coordinate's unit, F the unit of the force or torque that does work on it.")


def write_pages(folder: Path, pages: Mapping[str, str]) -> None:
    """Write effects.md and its pictures, given by path."""
    for name, text in pages.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8", newline="\n")
    typer.echo(f"wrote {folder / 'effects.md'}")


def _unit(parameter: Parameter) -> str:
    return parameter.unit.format(f="F", x="x")


def _bounds(parameter: Parameter) -> str:
    low, high = parameter.bounds
    if math.isinf(low) and math.isinf(high):
        return "any"
    if math.isinf(high):
        return f">= {low:g}"
    return f"{low:g} to {high:g}" if math.isfinite(low) else f"<= {high:g}"


def _data(effect: type[Definition]) -> dict[str, Any]:
    linear = {p.name for p in effect.linear}
    return {
        "name": effect.name,
        "text": effect.text,
        "reference": effect.reference,
        "scope": effect.scope,
        "side": effect.side,
        "confused_with": list(effect.confused_with),
        "experiment": effect.experiment,
        "states": list(effect.states),
        "parameters": [
            {
                "name": p.name,
                "unit": _unit(p),
                "text": p.text,
                "linear": p.name in linear,
                "symbol": p.symbol or None,
                "default": p.default,
                # null: no bound on this side
                "bounds": [bound if math.isfinite(bound) else None for bound in p.bounds],
            }
            for p in effect.accepted()
        ],
    }
