"""modelgen import: an arm from a robot in another format."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from modelgen.cli.guard import guarded
from modelgen.cli.options import Json

# ruff: noqa: PLC0415 - the help is quick

Source = Annotated[
    Path,
    typer.Argument(
        metavar="FILE", help="URDF, MJCF, or a CSV table of standard DH parameters.", show_default=False
    ),
]
Root = Annotated[
    str | None,
    typer.Option(metavar="LINK", help="Link that the arm stands on. Default: the first.", show_default=False),
]
Tip = Annotated[
    str | None,
    typer.Option(metavar="LINK", help="Link that the arm ends with. Default: all.", show_default=False),
]
Lock = Annotated[
    list[str] | None,
    typer.Option("--lock", metavar="JOINT=VALUE", help="Hold a joint [rad, m]; repeatable."),
]
Name = Annotated[
    str | None,
    typer.Option(metavar="NAME", help="Name of the arm. Default: the source's.", show_default=False),
]
Exact = Annotated[bool, typer.Option("--exact", help="Keep rounded angles such as 1.5708 as they are.")]
OutFile = Annotated[
    Path, typer.Option("-o", "--out", metavar="FILE", help="File to write; it must not exist.")
]


@guarded
def import_(
    source: Source,
    *,
    root: Root = None,
    tip: Tip = None,
    lock: Lock = None,
    name: Name = None,
    exact: Exact = False,
    out: OutFile = Path("arms.yaml"),
    as_json: Json = False,
) -> None:
    """Write the description of a robot in URDF or MJCF, or of a table of standard DH parameters."""
    from modelgen.api.importing import import_robot
    from modelgen.cli.output import print_result
    from modelgen.files import check_writable
    from modelgen.simulation.values import locks

    check_writable("--out", out)
    held = locks(lock or [])
    found = import_robot(source, root=root, tip=tip, lock=held, name=name, exact=exact)
    found.write(out)
    print_result(found, as_json=as_json)
    shown = "" if out == Path("arms.yaml") else f" {out}"
    typer.echo(f"wrote {out}; next: modelgen generate{shown}", err=True)
