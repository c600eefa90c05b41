"""modelgen init: the first description."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from modelgen.cli.guard import guarded

NewName = Annotated[str, typer.Argument(help="Name of the arm, a C identifier.", show_default=False)]
Kind = Annotated[
    str,
    typer.Option(
        "--from",
        metavar="KIND",
        help="The arm that yours is most like: levered, direct, industrial6, scara or tree.",
    ),
]
OutFile = Annotated[Path, typer.Option(metavar="FILE", help="File to write; it must not exist.")]


@guarded
def init(name: NewName, kind: Kind = "levered", out: OutFile = Path("arms.yaml")) -> None:
    """Write a commented description that generates as it stands."""
    from modelgen.description import starter  # noqa: PLC0415 - the help is quick
    from modelgen.files import write_new  # noqa: PLC0415

    write_new(out, starter(name, kind))
    shown = "" if out == Path("arms.yaml") else f" {out}"
    typer.echo(f"wrote {out}; next: modelgen generate{shown}", err=True)
