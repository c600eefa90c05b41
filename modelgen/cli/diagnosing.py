"""modelgen diagnose: progress, diagnosis.json, the extended description with its code, the report."""

from __future__ import annotations

import json
import shutil
from collections.abc import Sequence
from pathlib import Path

import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

from modelgen.cli.output import print_json, print_table
from modelgen.description import Arm, load
from modelgen.diagnosis.objects import Diagnosis, to_json
from modelgen.diagnosis.run import diagnose, records
from modelgen.effects import known_effects
from modelgen.errors import InputError
from modelgen.extension import extended_yaml
from modelgen.functions import Options
from modelgen.generation import generate
from modelgen.report.diagnosis import pictures, report


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
    as_json: bool,
) -> None:
    """Diagnose and write everything into `out`. Raises InputError."""
    if out.exists() and not out.is_dir():
        raise InputError(f"--out {out}: found a file, expected a folder")
    console = Console(stderr=True)
    columns = TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn()
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("reading")
        found = records(arm, train, test, mapping)

        def progress(text: str, done: int, total: int) -> None:
            bar.update(task, description=text, completed=done, total=total)

        result = diagnose(arm, found, cutoff=cutoff, period=period, progress=progress)
        bar.update(task, description="writing", completed=0, total=None)
        write(result, file, out)
    if as_json:
        print_json(to_json(result))
        return
    _print(result, out)


def write(d: Diagnosis, file: Path, out: Path) -> None:
    """diagnosis.json, report.html, the extended description and its code: whole, or nothing."""
    trials = [c.trial for c in d.selection.causes]
    causes = [(t.candidate.effect, t.candidate.joint, t.parameters) for t in trials]
    name = d.arm.name
    new = out.with_name(f".{out.name}.new")
    try:
        shutil.rmtree(new, ignore_errors=True)
        new.mkdir(parents=True)
        extended = extended_yaml(file, d.arm, causes)
        (new / f"{name}_extended.yaml").write_text(extended, encoding="utf-8", newline="\n")
        values = {key: float(f"{e.value:.12g}") for key, e in d.parameters.items()}
        (arm,) = load(new / f"{name}_extended.yaml", known_effects()).values()
        generate([arm], new / "generated", Options(identified=values), processes=1)
        text = json.dumps(to_json(d), indent=2, allow_nan=False) + "\n"
        (new / "diagnosis.json").write_text(text, encoding="utf-8", newline="\n")
        (new / "report.html").write_text(report(d), encoding="utf-8", newline="\n")
        for picture, drawn in pictures(d).items():
            (new / picture).write_text(drawn, encoding="utf-8", newline="\n")
        out.mkdir(parents=True, exist_ok=True)
        for path in sorted(new.iterdir()):
            target = out / path.name
            if target.is_dir():
                shutil.rmtree(target)
            path.replace(target)
    except OSError as error:
        raise InputError(f"--out {out}: cannot write: {error.strerror or error}") from error
    finally:
        shutil.rmtree(new, ignore_errors=True)


def sentence(d: Diagnosis) -> str:
    """The verdict for a person."""
    if d.verdict == "named":
        said = [f"{c.effect} {'of the arm' if c.joint is None else f'at joint {c.joint}'}" for c in d.causes]
        gains = d.errors.gain[~(d.errors.gain != d.errors.gain)]
        best = max(gains, default=0.0)
        return f"The model lacks {' and '.join(said)}: {best:.1f} % less error on the test record with it."
    return {
        "nothing_missing": "Nothing is missing that these records could show.",
        "outside_catalogue": "Something is missing that is not in the catalogue.",
        "cannot_tell": "These records cannot tell.",
    }[d.verdict] + f" {d.reason[0].upper()}{d.reason[1:]}."


def _print(d: Diagnosis, out: Path) -> None:
    typer.echo(sentence(d))
    rows = []
    for c in d.causes:
        values = ", ".join(f"{n} {e.value:.4g} {e.unit}".rstrip() for n, e in c.parameters.items())
        place = "arm" if c.joint is None else str(c.joint)
        rivals = ", ".join(f"{e} {j or 'arm'}" for e, j, _ in c.ambiguous_with)
        same = ", ".join(f"{e} {j or 'arm'}" for e, j in c.aliases)
        rows.append([c.effect, place, values, f"{c.delta_bic:.1f}", f"{c.cross_gain:.1f}", rivals, same])
    if rows:
        headings = ("cause", "joint", "parameters", "delta BIC", "gain %", "or perhaps", "the same as")
        print_table("", dict.fromkeys(headings, "left"), rows)
    table = []
    for j in range(len(d.errors.before)):
        e = d.errors
        interval = f"{e.low[j]:.1f} to {e.high[j]:.1f}"
        table.append([str(j + 1), f"{e.before[j]:.4g}", f"{e.after[j]:.4g}", f"{e.gain[j]:.1f}", interval])
    title = f"error on the test record [{d.errors.unit}]"
    print_table(title, dict.fromkeys(("joint", "before", "after", "gain %", "95 %"), "right"), table)
    typer.echo(f"report: {out / 'report.html'}")
