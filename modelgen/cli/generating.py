"""modelgen generate: progress, the table of what was generated, and what has drifted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

from modelgen.cli.guard import CHECK_FAILED
from modelgen.cli.output import print_json, print_table
from modelgen.description import Arm
from modelgen.description.messages import suggest
from modelgen.errors import InputError
from modelgen.functions import Options
from modelgen.generation import TARGETS, Budget, GeneratedArm, Report, generate


def run(
    arms: Sequence[Arm],
    file: str,
    options: Options,
    out: Path,
    *,
    check: bool,
    artefacts: Sequence[str],
    budget: Budget | None,
    processes: int | None,
    as_json: bool,
    identified: Mapping[str, Mapping[str, float]] | None = None,
) -> None:
    """Generate or check, and print the outcome. Raises InputError, and typer.Exit where a check fails."""
    console = Console(stderr=True)
    columns = TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn()
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("generating", total=len(arms))
        report = generate(
            arms,
            out,
            options,
            check=check,
            artefacts=artefacts,
            budget=budget,
            processes=processes,
            identified=identified,
            progress=lambda name: bar.update(task, advance=1, description=name),
        )
    for arm in arms:
        for note in arm.notes:
            typer.echo(f"{file}: {arm.name}: {note}", err=True)
    if as_json:
        print_json(_data(report))
    else:
        _table(report)
    if report.excess and budget is not None:
        for found in report.excess:
            typer.echo(
                f"{found.function}: {found.bytes} bytes of {found.kind} on {budget.target}, "
                f"budget {found.budget}",
                err=True,
            )
        typer.echo(f"over budget: nothing is written under {out}", err=True)
        raise typer.Exit(CHECK_FAILED)
    if report.drift:
        for drift in report.drift:
            typer.echo(f"{drift.path}: {drift.kind}", err=True)
        count = f"{len(report.drift)} file{'s' if len(report.drift) > 1 else ''}"
        typer.echo(f"{count} under {out} differ from what {file} describes; run modelgen generate", err=True)
        raise typer.Exit(CHECK_FAILED)


def budget_of(target: str, flash: int | None, stack: int | None) -> Budget | None:
    """The budget, None where nothing is limited. Raises InputError for a target that does not exist."""
    if target not in TARGETS:
        raise InputError(f"--target: found '{target}'{suggest(target, TARGETS)}")
    return None if flash is None and stack is None else Budget(target, flash, stack)


def total(operations: Mapping[str, int]) -> int:
    """Multiplications, additions and negations."""
    return sum(operations[kind] for kind in ("mul", "add", "neg"))


def _costs(operations: Mapping[str, Mapping[str, int]]) -> list[str]:
    """A function and its twin for the standard parameters share an entry."""
    costs = []
    for name, counts in operations.items():
        twin = operations.get(f"{name}_standard")
        if twin is not None:
            costs.append(f"{name} {total(counts)}/{total(twin)}")
        elif name.removesuffix("_standard") not in operations or name == name.removesuffix("_standard"):
            costs.append(f"{name} {total(counts)}")
    return costs


def _table(report: Report) -> None:
    rows = [
        [
            arm.name,
            str(arm.joints),
            f"{arm.standard_parameters} → {arm.base_parameters}",
            ", ".join(_costs(arm.operations)),
            str(len(arm.files) + len(arm.artefacts)),
        ]
        for arm in report.arms
    ]
    columns = {
        "arm": "left",
        "joints": "right",
        "parameters\nstandard → base": "right",
        "operations (mul + add + neg), base/standard parameters": "left",
        "files": "right",
    }
    print_table("", columns, rows)


def _data(report: Report) -> dict[str, Any]:
    return {
        "arms": [_arm_data(arm) for arm in report.arms],
        "drift": [{"path": str(drift.path), "kind": drift.kind} for drift in report.drift],
    }


def _arm_data(arm: GeneratedArm) -> dict[str, Any]:
    return {
        "arm": arm.name,
        "joints": arm.joints,
        "standard_parameters": arm.standard_parameters,
        "base_parameters": arm.base_parameters,
        "functions": arm.operations,
        "files": sorted({**arm.files, **arm.artefacts}),
    }
