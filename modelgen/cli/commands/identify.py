"""modelgen identify: parameters from logs."""

from __future__ import annotations

from typing import Annotated

import typer

from modelgen.cli.guard import guarded
from modelgen.cli.options import Arms, Folder, Json, OneArm, Train, Verbose, with_options
from modelgen.options import IdentificationOptions

# ruff: noqa: PLC0415 - the help is quick

Test = Annotated[
    list[str] | None,
    typer.Option("--test", metavar="LOG", help="A record not fitted; repeatable.", show_default=False),
]


@guarded
@with_options()
def identify(
    *,
    train: Train,
    out: Folder,
    test: Test = None,
    arms: Arms = None,
    arm: OneArm = "",
    options: IdentificationOptions,
    verbose: Verbose = False,
    as_json: Json = False,
) -> None:
    """Find the base parameters from logs, with their uncertainty, and validate them on other logs."""
    from modelgen.api.identification import identify as identified
    from modelgen.cli.arms import one
    from modelgen.cli.output import print_result, progress_bar, say, say_next
    from modelgen.files import check_folder

    found = one(arms, arm)
    check_folder("--out", out)
    with progress_bar(counted=False) as progress:
        result = identified(found, train, test or [], options, progress=progress)
    result.write(out)
    print_result(result, as_json=as_json)
    if as_json:
        return
    for line in result.details() if verbose else []:
        say(line)
    say_next(out / "report.html", result.next_steps(out))
