"""modelgen generate: what was generated, and what has drifted."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from modelgen.cli.guard import CHECK_FAILED, guarded
from modelgen.cli.options import Arms, Json, Parameters, with_options
from modelgen.options import GenerationOptions, ModelOptions

# ruff: noqa: PLC0415 - the help is quick

OnlyArms = Annotated[
    list[str] | None, typer.Option(metavar="NAME", help="Only this arm; repeatable.", show_default=False)
]
OutFolder = Annotated[Path, typer.Option(metavar="DIR", help="Folder that gets one folder per arm.")]
Identified = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="identification.json: folds in its parameters, and sets gains and thresholds of the watch.",
        show_default=False,
    ),
]
Verbose = Annotated[bool, typer.Option("--verbose", help="Operations of every function too.")]
Check = Annotated[bool, typer.Option("--check", help="Write nothing; exit 1 where DIR differs.")]


@guarded
@with_options()
def generate(
    *,
    arms: Arms = None,
    arm: OnlyArms = None,
    out: OutFolder = Path("generated"),
    check: Check = False,
    options: ModelOptions,
    generation: GenerationOptions,
    parameters: Parameters = None,
    identification: Identified = None,
    verbose: Verbose = False,
    as_json: Json = False,
) -> None:
    """Write C99 and CasADi functions of every arm, with identified parameters folded in where given."""
    from modelgen.api.generation import generate as generated
    from modelgen.cli.arms import selected
    from modelgen.cli.output import print_result, print_table, progress_bar, say

    file, found = selected(arms, arm or [])
    with progress_bar() as progress:
        result = generated(
            found,
            out,
            options,
            generation,
            parameters=parameters,
            identification=identification,
            check=check,
            progress=progress,
        )
    for one in found:
        for note in one.notes:
            typer.echo(f"{file}: {one.name}: {note}", err=True)
    print_result(result, as_json=as_json)
    if verbose and not as_json:
        print_table(result.details())
    if result.excess and result.budget is not None:
        for above in result.excess:
            typer.echo(
                f"{above.function}: {above.bytes} bytes of {above.kind} on {result.budget.target}, "
                f"budget {above.budget}",
                err=True,
            )
        typer.echo(f"over budget: nothing is written under {out}", err=True)
        raise typer.Exit(CHECK_FAILED)
    if result.drift:
        for drift in result.drift:
            typer.echo(f"{drift.path}: {drift.kind}", err=True)
        count = f"{len(result.drift)} file{'s' if len(result.drift) > 1 else ''}"
        typer.echo(f"{count} under {out} differ from what {file} describes; run modelgen generate", err=True)
        raise typer.Exit(CHECK_FAILED)
    if not (check or as_json):
        say(f"code: {out / found[0].name if len(found) == 1 else out}")
