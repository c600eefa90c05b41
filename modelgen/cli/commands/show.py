"""modelgen show: base parameters, their grouping, and what the functions cost."""

from __future__ import annotations

from modelgen.cli.guard import guarded
from modelgen.cli.options import Arms, Json, OneArm, with_options
from modelgen.options import ModelOptions


@guarded
@with_options()
def show(*, arms: Arms = None, arm: OneArm = "", options: ModelOptions, as_json: Json = False) -> None:
    """Print base parameters, their grouping, and what the functions cost."""
    from modelgen.api.model import build_model  # noqa: PLC0415 - the help is quick
    from modelgen.cli.arms import one  # noqa: PLC0415
    from modelgen.cli.output import print_result  # noqa: PLC0415

    print_result(build_model(one(arms, arm), options), as_json=as_json)
