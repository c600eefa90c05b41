"""modelgen show: base parameters, their grouping, and what the functions cost."""

from __future__ import annotations

from typing import Annotated

import typer

from modelgen.cli.guard import guarded
from modelgen.cli.options import Arms, Json, OneArm, with_options
from modelgen.options import ModelOptions

MORE = "standard parameters without effect on the input, and operations by kind"
Verbose = Annotated[bool, typer.Option("--verbose", help=f"Besides: {MORE}.")]


@guarded
@with_options()
def show(
    *,
    arms: Arms = None,
    arm: OneArm = "",
    options: ModelOptions,
    verbose: Verbose = False,
    as_json: Json = False,
) -> None:
    """Print base parameters, their grouping, and what the functions cost."""
    from modelgen.api.model import build_model  # noqa: PLC0415 - the help is quick
    from modelgen.cli.arms import one  # noqa: PLC0415
    from modelgen.cli.output import print_result, print_table, say  # noqa: PLC0415

    result = build_model(one(arms, arm), options)
    print_result(result, as_json=as_json)
    if as_json:
        return
    if not verbose:
        say(f"--verbose prints besides: {MORE}")
        return
    for table in result.details():
        print_table(table)
