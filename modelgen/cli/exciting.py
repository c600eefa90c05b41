"""modelgen excite: an excitation trajectory with its set-points, figures and picture."""

from __future__ import annotations

from pathlib import Path

import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from modelgen.cli.files import check_writable, write_together
from modelgen.cli.output import print_json, print_table
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.excitation import Excitation, Settings, excite
from modelgen.excitation.writing import data, files


def run(arm: Arm, settings: Settings, out: Path, *, as_json: bool) -> None:
    """Optimise, write, print. Raises InputError."""
    settings.checked()
    check_writable("--out", out)
    if out.suffix.lower() != ".csv":
        raise InputError(f"--out {out}: found '{out.suffix}', expected a name that ends in .csv")
    console = Console(stderr=True)
    columns = TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn()
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task(f"{arm.name}: starts", total=settings.starts)
        found = excite(arm, settings, lambda done, _: bar.update(task, completed=done))
    texts = files(found, out.stem)
    write_together("--out", out.parent, texts)
    if as_json:
        print_json(data(found))
    else:
        _print(found, [out.parent / name for name in texts])


def _print(e: Excitation, paths: list[Path]) -> None:
    made = data(e)
    for remark in made["remarks"]:
        typer.echo(f"note: {remark}")
    typer.echo(
        f"{e.arm.name}: condition number {e.condition:.4g} with columns of unit norm ({e.raw:.3g} in the "
        f"parameters' own units), {made['base_parameters']} base parameters, {made['samples']} samples"
    )
    reached = made["condition_numbers_of_starts"]
    typer.echo(f"starts: {len(reached)}, from {reached[0]:.4g} to {reached[-1]:.4g}")
    rows = [[name, f"{100 * share:.1f}"] for name, share in e.usage.items()]
    print_table("limits", {"limit": "left", "used %": "right"}, rows)
    for path in paths:
        typer.echo(f"wrote {path}")
