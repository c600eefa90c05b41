"""modelgen export: an arm in the format of a simulator."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from modelgen.cli.guard import guarded
from modelgen.cli.options import Arms, Json, OneArm, Parameters

# ruff: noqa: PLC0415 - the help is quick

To = Annotated[str, typer.Option("--to", metavar="FORMAT", help="mjcf, urdf or fmu.", show_default=False)]
OutFile = Annotated[
    Path, typer.Option("-o", "--out", metavar="FILE", help="File to write.", show_default=False)
]

Fmi = Annotated[
    str | None,
    typer.Option("--fmi", metavar="VERSION", help="Of an FMU: 2.0 (the default) or 3.0.", show_default=False),
]


@guarded
def export(
    *,
    arms: Arms = None,
    arm: OneArm = "",
    parameters: Parameters = None,
    to: To,
    out: OutFile,
    fmi: Fmi = None,
    as_json: Json = False,
) -> None:
    """Write an arm as a model of a simulator, and say of every effect whether it is exact there."""
    from modelgen.api.exporting import export as exported
    from modelgen.cli.arms import one
    from modelgen.cli.output import print_result

    found = exported(one(arms, arm), to=to, out=out, parameters=parameters, fmi=fmi)
    print_result(found, as_json=as_json)
    typer.echo(f"wrote {out}", err=True)
