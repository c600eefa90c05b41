"""modelgen fleet: progress, counts, where table and page are."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from modelgen.cli.output import print_json, print_table
from modelgen.errors import InputError
from modelgen.fleet.overview import FAILED, WORDS, causes, verdicts
from modelgen.fleet.run import PAGE, Fleet, diagnose_fleet
from modelgen.fleet.table import NAME
from modelgen.fleet.units import Unit
from modelgen.jobs import Where

_SHOWN = 10  # failures and causes


def run(
    file: Path, units: Sequence[Unit], out: Path, where: Where, *, again: bool, code: bool, as_json: bool
) -> None:
    """Diagnose the units of a file, print what was found.

    Raises InputError, also where no unit could be diagnosed.
    """
    console = Console(stderr=True)
    columns = TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn()
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("diagnosing", total=len(units))
        found = diagnose_fleet(
            units,
            out,
            where,
            again=again,
            code=code,
            progress=lambda done, total: bar.update(task, completed=done, total=total),
        )
    said = data(found, out)
    if as_json:
        print_json(said)
    else:
        _print(said)
    if said["verdicts"][FAILED] == len(units):
        first = said["failed"][0]
        raise InputError(f"no unit of {file} could be diagnosed; {first['unit']}: {first['error']}")


def data(found: Fleet, out: Path) -> dict[str, Any]:
    """What is printed, for machines."""
    counts = verdicts(found.rows)
    named = sorted(causes(found.rows).items(), key=lambda item: (-item[1], item[0][0], item[0][1] or 0))
    return {
        "units": len(found.rows),
        "kept": found.kept,
        "verdicts": {key: counts[key] for key in WORDS},
        "causes": [{"effect": effect, "joint": joint, "units": n} for (effect, joint), n in named],
        "failed": [{"unit": r["unit"], "error": r["error"]} for r in found.rows if r.get("error")],
        "cpu_seconds": round(sum(r.get("cpu_seconds") or 0.0 for r in found.rows), 1),
        "table": str(out / NAME),
        "overview": str(out / PAGE),
    }


def _print(said: dict[str, Any]) -> None:
    kept = f", {said['kept']} of them from before" if said["kept"] else ""
    counts = ", ".join(f"{n} {WORDS[key]}" for key, n in said["verdicts"].items() if n)
    units = "1 unit" if said["units"] == 1 else f"{said['units']} units"
    typer.echo(f"{units}{kept}: {counts}")
    rows = [
        [c["effect"], "arm" if c["joint"] is None else str(c["joint"]), str(c["units"])]
        for c in said["causes"][:_SHOWN]
    ]
    if rows:
        print_table("", {"cause": "left", "joint": "left", "units": "right"}, rows)
    for failed in said["failed"][:_SHOWN]:
        typer.echo(f"failed: {failed['unit']}: {failed['error']}", err=True)
    if len(said["failed"]) > _SHOWN:
        typer.echo(f"failed: {len(said['failed']) - _SHOWN} more, see the table", err=True)
    typer.echo(f"table: {said['table']}")
    typer.echo(f"overview: {said['overview']}")
