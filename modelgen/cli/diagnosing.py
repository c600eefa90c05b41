"""modelgen diagnose: progress, diagnosis.json, the extended description with its code, the report."""

from __future__ import annotations

from collections.abc import Sequence
from math import isnan
from pathlib import Path

import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

from modelgen.cli.output import print_json, print_table
from modelgen.description import Arm
from modelgen.diagnosis.pipeline import diagnose, records
from modelgen.diagnosis.result import Diagnosis, to_json
from modelgen.errors import InputError
from modelgen.generation.folders import check_output
from modelgen.jobs import Where
from modelgen.report.diagnosis import assumptions, harms, sketches, unnamed
from modelgen.report.experiment import followed
from modelgen.report.figures import Pen
from modelgen.report.writing import write


def run(
    file: Path,
    arm: Arm,
    train: Sequence[str],
    test: Sequence[str],
    out: Path,
    *,
    mapping: Path | None,
    cutoff: float | None,
    period: float | None,
    effects: Sequence[str],
    experiment: bool,
    jobs: int | None,
    as_json: bool,
    pen: Pen,
) -> None:
    """Diagnose and write everything into `out`. pen: draws the pictures. Raises InputError."""
    if out.exists() and not out.is_dir():
        raise InputError(f"--out {out}: found a file, expected a folder")
    check_output(out, [])
    wanted = [_place(text) for text in effects]
    console = Console(stderr=True)
    columns = TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn()
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("reading")
        found = records(arm, train, test, mapping)

        def progress(text: str, done: int, total: int) -> None:
            bar.update(task, description=text, completed=done, total=total)

        result = diagnose(
            arm,
            found,
            cutoff=cutoff,
            period=period,
            progress=progress,
            experiment=experiment,
            effects=wanted,
            where=Where(jobs),
            known=lambda found: pen.give(sketches(found)),
        )
        bar.update(task, description="writing", completed=0, total=None)
        write(result, file, out, pen=pen)
    if as_json:
        print_json(to_json(result))
        return
    _print(result, out)


def _place(text: str) -> tuple[str, int | None]:
    """Effect and joint of NAME or NAME:JOINT. Raises InputError."""
    name, colon, joint = text.partition(":")
    if colon and not joint.isdecimal():
        raise InputError(f"--effect {text}: found '{joint}', expected a joint from 1, as in {name}:2")
    return name, int(joint) if colon else None


def sentence(d: Diagnosis) -> str:
    """The verdict for a person."""
    if d.verdict == "named":
        said = [f"{c.effect} {'of the arm' if c.joint is None else f'at joint {c.joint}'}" for c in d.causes]
        gains = d.errors.gain[~(d.errors.gain != d.errors.gain)]
        best = max(gains, default=0.0)
        gained = f"{best:.1f} % less error" if best > 0.0 else "no less error"
        return f"The model lacks {' and '.join(said)}: {gained} on the test record with it."
    return f"{unnamed(d)} {d.reason[0].upper()}{d.reason[1:]}."


def _print(d: Diagnosis, out: Path) -> None:
    typer.echo(sentence(d))
    rows = []
    for c in d.causes:
        values = ", ".join(f"{n} {e.value:.4g} {e.unit}".rstrip() for n, e in c.parameters.items())
        place = "arm" if c.joint is None else str(c.joint)
        rivals = ", ".join(f"{e} {j or 'arm'}" for e, j, _ in c.ambiguous_with)
        same = ", ".join(f"{e} {j or 'arm'}" for e, j in c.aliases)
        gains = f"{c.cross_gain:.1f}", "" if isnan(c.share.gain) else f"{c.share.gain:.1f}"
        rows.append([c.effect, place, values, f"{c.delta_bic:.1f}", *gains, rivals, same])
    if rows:
        headings = (
            "cause",
            "joint",
            "parameters",
            "delta BIC",
            "gain %",
            "on test %",
            "or perhaps",
            "the same as",
        )
        print_table("", dict.fromkeys(headings, "left"), rows, names=("cause",))
    table = []
    for j in range(len(d.errors.before)):
        e = d.errors
        interval = f"{e.low[j]:.1f} to {e.high[j]:.1f}"
        table.append([str(j + 1), f"{e.before[j]:.4g}", f"{e.after[j]:.4g}", f"{e.gain[j]:.1f}", interval])
    title = f"error on the test record [{d.errors.unit}]"
    print_table(title, dict.fromkeys(("joint", "before", "after", "gain %", "95 %"), "right"), table)
    for said in (*harms(d), *assumptions(d)):
        typer.echo(said)
    if d.next_experiment is not None:
        typer.echo(f"next: {followed(d.next_experiment)}")
    typer.echo(f"report: {out / 'report.html'}")
