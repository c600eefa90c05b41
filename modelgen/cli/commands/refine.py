"""modelgen refine: parameters tuned until the simulated motion is the measured one."""

from __future__ import annotations

from typing import Annotated

import typer

from modelgen.cli.guard import CHECK_FAILED, guarded
from modelgen.cli.options import Arms, Folder, Json, OneArm, with_options
from modelgen.options import RefinementOptions

# ruff: noqa: PLC0415 - the help is quick

Logs = Annotated[
    list[str],
    typer.Option(
        "--log", metavar="LOG", help="A measured motion, FILE or FILE@t0:t1 [s], effort or none; repeatable."
    ),
]


@guarded
@with_options()
def refine(
    *,
    log: Logs,
    out: Folder,
    arms: Arms = None,
    arm: OneArm = "",
    options: RefinementOptions,
    as_json: Json = False,
) -> None:
    """Tune base parameters until the simulated motion is the measured one; exit 1 where that does not end."""
    from modelgen.api.refinement import refine as refined
    from modelgen.cli.arms import one
    from modelgen.cli.output import print_result, progress_bar, say_next
    from modelgen.files import check_folder

    found = one(arms, arm)
    check_folder("--out", out)
    with progress_bar() as progress:
        result = refined(found, log, options, progress=progress)
    result.write(out)
    print_result(result, as_json=as_json)
    if not as_json:
        say_next(out / "report.html", result.next_steps(out))
    if not result.converged:
        typer.echo(f"not converged: {result.found.stopped}; what was found so far is in {out}", err=True)
        raise typer.Exit(CHECK_FAILED)
