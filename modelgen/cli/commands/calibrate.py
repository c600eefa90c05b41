"""modelgen calibrate: a lever's geometry, the description with it, and a picture."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from modelgen.cli.guard import guarded
from modelgen.cli.options import Folder, Json, OneArm, with_options
from modelgen.options import CalibrationOptions

# ruff: noqa: PLC0415 - the help is quick

ArmsAndLog = Annotated[
    list[str],
    typer.Argument(
        metavar="[ARMS] LOG",
        help="The description, and the log with t, qm<J> and the measured q<J> in rad.",
        show_default=False,
    ),
]
LeverJoint = Annotated[
    str, typer.Option(metavar="JOINT", help="The joint by its name or number, from 1.", show_default=False)
]


@guarded
@with_options()
def calibrate(
    *,
    files: ArmsAndLog,
    joint: LeverJoint,
    arm: OneArm = "",
    out: Folder = Path("calibration"),
    options: CalibrationOptions,
    as_json: Json = False,
) -> None:
    """Fit a lever's geometry to motor counts and measured joint angles."""
    from modelgen.api.calibration import calibrate as calibrated
    from modelgen.cli.arms import one
    from modelgen.cli.output import print_result, say_next
    from modelgen.errors import InputError
    from modelgen.files import check_folder

    if len(files) > 2:
        raise InputError(f"found {len(files)} files ({', '.join(files)}), expected [ARMS] LOG")
    found = one(Path(files[0]) if len(files) == 2 else None, arm)
    check_folder("--out", out)
    result = calibrated(found, joint, files[-1], options)
    result.write(out)
    print_result(result, as_json=as_json)
    if not as_json:
        say_next(out / "report.html", result.next_steps(out))
