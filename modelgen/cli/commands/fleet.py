"""modelgen fleet: the logs of many arms as one job."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from modelgen.cli.guard import CHECK_FAILED, guarded
from modelgen.cli.options import Dask, Folder, Jobs, Json

# ruff: noqa: PLC0415 - the help is quick

FleetFile = Annotated[
    Path,
    typer.Argument(
        metavar="FLEET", help="The units and their records in YAML, see docs/fleet.md.", show_default=False
    ),
]
Again = Annotated[bool, typer.Option("--again", help="Also make the units anew that failed before.")]
Code = Annotated[bool, typer.Option("--code", help="Write the code of every unit's extended model too.")]


@guarded
def fleet(
    file: FleetFile,
    out: Folder,
    jobs: Jobs = None,
    dask: Dask = None,
    again: Again = False,
    code: Code = False,
    as_json: Json = False,
) -> None:
    """Diagnose the logs of many arms as one job, which goes on after an interruption: one table, one page.

    Exit 1 where a unit could not be diagnosed, all else is written; 2 where none could.
    """
    from modelgen.cli.output import print_result, progress_bar, say
    from modelgen.fleet.units import load_fleet

    units = load_fleet(file)
    from modelgen.errors import InputError
    from modelgen.fleet.run import SHOWN, diagnose_fleet
    from modelgen.jobs import Where

    with progress_bar() as progress:
        found = diagnose_fleet(
            units,
            out,
            Where(jobs, dask),
            again=again,
            code=code,
            file=file,
            progress=lambda done, total: progress("diagnosing", done, total),
        )
    print_result(found, as_json=as_json)
    failed = found.to_json()["failed"]
    if not as_json:
        for unit in failed[:SHOWN]:
            typer.echo(f"failed: {unit['unit']}: {unit['error']}", err=True)
        if len(failed) > SHOWN:
            typer.echo(f"failed: {len(failed) - SHOWN} more, see the table", err=True)
        if len(failed) < len(units):
            for text, command in found.next_steps():
                say(text, command)
    if len(failed) == len(units):
        raise InputError(f"no unit of {file} could be diagnosed; {failed[0]['unit']}: {failed[0]['error']}")
    if failed:
        raise typer.Exit(CHECK_FAILED)
