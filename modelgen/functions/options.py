"""Options of an arm's functions."""

from __future__ import annotations

from dataclasses import replace

from modelgen.description.objects import Arm
from modelgen.effects import described
from modelgen.geometry import with_geometry_symbols
from modelgen.options import GAINS, PARTS, ModelOptions
from modelgen.transmission import UNDRIVEN

Options = ModelOptions
EVALUATED = Options().evaluated

__all__ = ["EVALUATED", "GAINS", "PARTS", "Options", "prepared"]


def prepared(arm: Arm, options: Options) -> Arm:
    """The arm with drives or effects left out, and symbols in place of run-time geometry."""
    if "drives" in options.without:
        arm = replace(arm, joints=tuple(replace(joint, drive=UNDRIVEN) for joint in arm.joints))
    if "effects" in options.without:
        arm = arm.without_effects()
    arm = described(arm)
    return with_geometry_symbols(arm) if options.runtime_geometry else arm
