"""modelgen inspect: what a log says about itself."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from modelgen.cli.guard import guarded
from modelgen.cli.options import Json, OneArm

# ruff: noqa: PLC0415 - the help is quick

LogFile = Annotated[str, typer.Argument(metavar="LOG", help="FILE or FILE@t0:t1 [s].")]
Described = Annotated[
    Path | None,
    typer.Argument(
        metavar="ARMS", help="Description in YAML, for the columns of an arm.", show_default=False
    ),
]
Mapping = Annotated[
    Path | None,
    typer.Option("--mapping", metavar="FILE", help="Mapping file of a foreign log.", show_default=False),
]
Skeleton = Annotated[
    Path | None,
    typer.Option(
        "--skeleton", metavar="FILE", help="Write a mapping file to start from.", show_default=False
    ),
]

Plot = Annotated[
    Path | None, typer.Option("--plot", metavar="FILE", help="Picture, SVG.", show_default=False)
]


@guarded
def inspect(
    log: LogFile,
    arms: Described = None,
    *,
    arm: OneArm = "",
    mapping: Mapping = None,
    skeleton: Skeleton = None,
    plot: Plot = None,
    as_json: Json = False,
) -> None:
    """Say what is in a log: columns, units, rate, jitter, resolution, repeated readings, period, rest."""
    from modelgen.api.inspect import inspect_log, mapping_skeleton
    from modelgen.cli.arms import one
    from modelgen.cli.output import print_result
    from modelgen.errors import InputError
    from modelgen.files import check_writable, write_new, write_together

    if plot is not None and plot.suffix.lower() != ".svg":
        raise InputError(f"--plot {plot}: the picture is an SVG, expected {plot.with_suffix('.svg')}")
    found = one(arms, arm) if arms is not None or arm else None
    for option, path in (("--skeleton", skeleton), ("--plot", plot)):
        if path is not None:
            check_writable(option, path)
    if skeleton is not None and (found is not None or mapping is not None):
        write_new(skeleton, mapping_skeleton(log, found))
    result = inspect_log(log, found, mapping=mapping)
    if skeleton is not None and found is None and mapping is None:
        write_new(skeleton, mapping_skeleton(result))
    if plot is not None:
        write_together("--plot", plot.parent, {plot.name: result.picture()})
    print_result(result, as_json=as_json)
