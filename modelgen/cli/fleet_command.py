"""The options of modelgen fleet."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from modelgen.cli import arguments as given
from modelgen.cli.guard import guarded

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
    out: given.Folder,
    jobs: given.Jobs = None,
    dask: given.Dask = None,
    again: Again = False,
    code: Code = False,
    as_json: given.Json = False,
) -> None:
    """Diagnose the logs of many arms as one job that can be taken up again: one table, one page."""
    from modelgen.fleet.units import load_fleet

    units = load_fleet(file)
    from modelgen.cli.fleeting import run
    from modelgen.jobs import Where

    run(file, units, out, Where(jobs, dask), again=again, code=code, as_json=as_json)
