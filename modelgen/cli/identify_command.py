"""The options of modelgen identify."""

from __future__ import annotations

from typing import Annotated

import typer

from modelgen.cli import arguments as given
from modelgen.cli.guard import guarded

# ruff: noqa: PLC0415 - the help is quick

CompareDrives = Annotated[
    bool,
    typer.Option(
        "--compare-drives",
        help="Identify without the drives' dynamics too, and compare the errors on the test records.",
    ),
]


@guarded
def identify(
    arm: given.OneArm,
    train: given.Train,
    out: given.Folder,
    test: given.OptionalTest = None,
    arms: given.Arms = None,
    mapping: given.Mapping = None,
    cutoff: given.CutOff = None,
    preset: given.Preset = "default",
    method: given.Method = "wls",
    consistent: given.Consistent = False,
    stream: given.Streamed = False,
    compare_drives: CompareDrives = False,
    without: given.Without = "",
    as_json: given.Json = False,
) -> None:
    """Find the base parameters from logs, with their uncertainty, and validate them on other logs."""
    from modelgen.cli.identifying import run
    from modelgen.cli.selecting import options, selected

    chosen = options(without, given.Gains.KNOWN, False, False, None)
    _, (found,) = selected(arms, [arm])
    how = {"method": method, "physical": consistent}
    run(
        found,
        train,
        test or [],
        out,
        chosen,
        mapping,
        cutoff,
        how,
        preset=preset,
        stream=stream,
        compare=compare_drives,
        as_json=as_json,
    )
