"""modelgen simulate: a motion of the model, alone or against logs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from modelgen.cli.guard import guarded
from modelgen.cli.options import Arms, Json, OneArm, with_options
from modelgen.options import SimulationOptions

# ruff: noqa: PLC0415 - the help is quick

OptionalFile = Annotated[
    Path | None, typer.Option("--out", metavar="FILE", help="CSV to write: t, q, dq.", show_default=False)
]
Logs = Annotated[
    list[str] | None,
    typer.Option(
        "--log",
        metavar="LOG",
        help="Measured log, FILE or FILE@t0:t1, to be held against; repeatable for repeated runs.",
        show_default=False,
    ),
]
Plot = Annotated[Path | None, typer.Option(metavar="FILE", help="Picture, SVG.", show_default=False)]
Animation = Annotated[
    Path | None, typer.Option(metavar="FILE", help="The moving arm, one HTML file.", show_default=False)
]


@guarded
@with_options(before={"mapping": ("out", "log")})
def simulate(
    *,
    arms: Arms = None,
    arm: OneArm = "",
    options: SimulationOptions,
    out: OptionalFile = None,
    log: Logs = None,
    plot: Plot = None,
    animation: Animation = None,
    as_json: Json = False,
) -> None:
    """Simulate the model: free, under control, or with the inputs of a log to be held against it."""
    from modelgen.api.simulation import simulate as simulated
    from modelgen.cli.arms import one
    from modelgen.cli.output import print_result, progress_bar
    from modelgen.errors import InputError
    from modelgen.files import check_writable, write_together

    found = one(arms, arm)
    wanted = {"--out": out, "--plot": plot, "--animation": animation}
    for option, path in wanted.items():
        if path is not None:
            check_writable(option, path)
    with progress_bar(counted=False) as progress:
        result = simulated(found, log or [], options, progress=progress)
    makers = {"--out": result.table, "--plot": result.picture, "--animation": result.animation}
    for option, path in wanted.items():
        if path is not None:
            write_together(option, path.parent, {path.name: makers[option]()})
    print_result(result, as_json=as_json)
    for name, run in zip(result.found.logs, result.found.replays, strict=True):
        if run.ended:
            raise InputError(f"{name}: {run.ended}; the scores are those of the samples before it")
    if result.ended and not result.found.replays:
        kept = f"; the {len(result.t)} samples before it are in {out}" if out else ""
        raise InputError(f"{result.arm.name}: {result.ended}{kept}")
