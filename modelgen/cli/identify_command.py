"""The options of modelgen identify."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from modelgen.cli import arguments as given
from modelgen.cli.guard import guarded

# ruff: noqa: PLC0415 - the help is quick

Instrument = Annotated[
    str,
    typer.Option(
        metavar="NAME",
        help="auto, period (another period of the motion) or simulated (the model under its controller).",
    ),
]
Control = Annotated[
    str, typer.Option(metavar="NAME", help="Of the simulated instrument: pi (cascade) or computed_torque.")
]
ReferenceFile = Annotated[
    Path | None,
    typer.Option(
        "--reference",
        metavar="FILE",
        help="CSV with t and q<n> that the controller followed. Default: the filtered measured motion.",
        show_default=False,
    ),
]
Bandwidth = Annotated[
    float | None,
    typer.Option(
        metavar="HZ", help="Of that controller. Default: enough for the motion.", show_default=False
    ),
]
Gains = Annotated[
    given.Gains,
    typer.Option(
        help="Torque constants: known, estimated (from a --payload), or each row in its own scale.",
    ),
]
Payload = Annotated[
    list[str] | None,
    typer.Option(
        metavar="LOG=M[,X,Y,Z]",
        help="Point mass [kg] that the last link carries in a log, in its frame [m]; repeatable.",
        show_default=False,
    ),
]
CompareDrives = Annotated[
    bool,
    typer.Option(
        "--compare-drives",
        help="Identify without the drives' dynamics too, and compare the errors on the test records.",
    ),
]
Essential = Annotated[
    bool, typer.Option("--essential", help="Fit again with the parameters alone that the logs support.")
]
NumberOfFolds = Annotated[
    int | None,
    typer.Option(
        "--folds",
        metavar="K",
        min=2,
        help="Cross-validate: each of K parts of the training records held out in its turn.",
        show_default=False,
    ),
]


@guarded
def identify(
    train: given.Train,
    out: given.Folder,
    test: given.OptionalTest = None,
    arms: given.Arms = None,
    arm: given.OneArm = "",
    mapping: given.Mapping = None,
    cutoff: given.CutOff = None,
    preset: given.Preset = "default",
    method: given.Method = "wls",
    instrument: Instrument = "auto",
    control: Control = "pi",
    reference: ReferenceFile = None,
    bandwidth: Bandwidth = None,
    gains: Gains = given.Gains.KNOWN,
    payload: Payload = None,
    essential: Essential = False,
    compare_drives: CompareDrives = False,
    folds: NumberOfFolds = None,
    consistent: given.Consistent = False,
    stream: given.Streamed = False,
    without: given.Without = "",
    as_json: given.Json = False,
) -> None:
    """Find the base parameters from logs, with their uncertainty, and validate them on other logs."""
    from modelgen.cli.identifying import Request, run
    from modelgen.cli.selecting import one, options

    chosen = options(without, gains, False, False, None)
    file, found = one(arms, arm)
    request = Request(
        file=Path(file),
        train=train,
        test=test or [],
        out=out,
        mapping=mapping,
        cutoff=cutoff,
        preset=preset,
        method=method,
        instrument=instrument,
        control=control,
        reference=reference,
        bandwidth=bandwidth,
        payload=payload or [],
        essential=essential,
        compare=compare_drives,
        folds=folds,
        consistent=consistent,
        stream=stream,
        as_json=as_json,
    )
    run(found, chosen, request)
