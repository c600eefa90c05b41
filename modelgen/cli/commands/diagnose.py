"""modelgen diagnose: what the model gets wrong in logs, and the model extended by it."""

from __future__ import annotations

from typing import Annotated

import typer

from modelgen.cli.guard import guarded
from modelgen.cli.options import Arms, Folder, Json, OneArm, Train, Verbose, with_options
from modelgen.options import DiagnosisOptions

# ruff: noqa: PLC0415 - the help is quick

Test = Annotated[
    list[str] | None,
    typer.Option("--test", metavar="LOG", help="The record for the final errors alone; needed."),
]


@guarded
@with_options()
def diagnose(
    *,
    train: Train,
    out: Folder,
    test: Test = None,
    arms: Arms = None,
    arm: OneArm = "",
    options: DiagnosisOptions,
    verbose: Verbose = False,
    as_json: Json = False,
) -> None:
    """Name what the model gets wrong in logs, extend it by the cause, and measure the gain."""
    from modelgen.api.diagnosis import diagnosed
    from modelgen.cli.arms import one
    from modelgen.cli.output import print_result, progress_bar, say, say_next
    from modelgen.files import check_folder
    from modelgen.generation.folders import check_output

    found = one(arms, arm)
    check_folder("--out", out)
    check_output(out, [])
    with progress_bar() as progress:
        result = diagnosed(found, train, test or [], options, progress)
        progress("writing", 0, None)
        result.write(out)
    print_result(result, as_json=as_json)
    if as_json:
        return
    for line in result.details() if verbose else []:
        say(line)
    say_next(out / "report.html", result.next_steps())
