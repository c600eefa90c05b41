"""The options of modelgen refine."""

from __future__ import annotations

from typing import Annotated

import typer

from modelgen.cli import arguments as given
from modelgen.cli.guard import guarded

# ruff: noqa: PLC0415 - the help is quick

Logs = Annotated[
    list[str],
    typer.Option(
        "--log", metavar="LOG", help="A measured motion, FILE or FILE@t0:t1 [s], effort or none; repeatable."
    ),
]
Free = Annotated[
    list[str] | None,
    typer.Option(
        metavar="PARAMETER",
        help="Base parameter to tune; repeatable. Default: all with efforts, else those of the effects.",
        show_default=False,
    ),
]


@guarded
def refine(
    log: Logs,
    out: given.Folder,
    arms: given.Arms = None,
    arm: given.OneArm = "",
    mapping: given.Mapping = None,
    parameters: given.Parameters = None,
    free: Free = None,
    window: given.Window = None,
    as_json: given.Json = False,
) -> None:
    """Tune base parameters until the simulated motion is the measured one, with or without efforts."""
    from modelgen.cli.refining import run
    from modelgen.cli.selecting import one, with_parameters
    from modelgen.functions import Options

    _, found = one(arms, arm)
    values = with_parameters(Options(), parameters, [found]).identified or None
    run(found, values, log, out, mapping=mapping, free=free or [], window=window, as_json=as_json)
