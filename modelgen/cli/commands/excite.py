"""modelgen excite: an excitation trajectory with its set-points, figures and picture."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from modelgen.cli.guard import guarded
from modelgen.cli.options import Arms, Json, OneArm, with_options
from modelgen.options import ExcitationOptions

# ruff: noqa: PLC0415 - the help is quick

TrajectoryFile = Annotated[
    Path, typer.Option("--out", metavar="FILE", help="Table to write; its companions lie beside it.")
]


@guarded
@with_options()
def excite(
    *,
    arms: Arms = None,
    arm: OneArm = "",
    out: TrajectoryFile = Path("trajectory.csv"),
    options: ExcitationOptions,
    as_json: Json = False,
) -> None:
    """Compute a trajectory that determines the base parameters well, within the arm's limits."""
    from modelgen.api.excitation import excite as excited
    from modelgen.cli.arms import one
    from modelgen.cli.output import print_result, progress_bar, say, say_next
    from modelgen.errors import InputError
    from modelgen.files import check_writable

    found = one(arms, arm)
    options.checked()
    check_writable("--out", out)
    if out.suffix.lower() != ".csv":
        raise InputError(f"--out {out}: found '{out.suffix}', expected a name that ends in .csv")
    with progress_bar() as progress:
        result = excited(found, options, progress=progress)
    result.write(out.parent, out.stem)
    print_result(result, as_json=as_json)
    if as_json:
        return
    names = [name for name in result.files(out.parent, out.stem) if not name.endswith(".html")]
    say(f"wrote {', '.join(str(out.parent / name) for name in names)}")
    say_next(out.with_suffix(".html"), result.next_steps(out.parent, out.stem))
