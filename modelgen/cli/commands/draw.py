"""modelgen draw: an arm to look at."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from modelgen.cli.guard import guarded
from modelgen.cli.options import Arms, Json, OneArm

# ruff: noqa: PLC0415 - the help is quick

At = Annotated[
    str | None,
    typer.Option(
        "--q",
        metavar="VALUES",
        help='Coordinates that it is drawn at, in rad and m: "20 deg, 0.1, ..." or one for all joints. '
        "Default: zero, or the middle of a range without zero.",
        show_default=False,
    ),
]
OutFile = Annotated[Path, typer.Option("-o", "--out", metavar="FILE", help="HTML page to write.")]


@guarded
def draw(
    *,
    arms: Arms = None,
    arm: OneArm = "",
    q: At = None,
    out: OutFile = Path("arm.html"),
    as_json: Json = False,
) -> None:
    """Draw an arm: one HTML page with frames, levers and centres of mass, to turn and move."""
    from modelgen.api.drawing import draw as drawn
    from modelgen.cli.arms import one
    from modelgen.cli.output import print_result

    print_result(drawn(one(arms, arm), out, q), as_json=as_json)
    typer.echo(f"wrote {out}", err=True)
