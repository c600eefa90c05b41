"""What may be chosen about the functions of an arm."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from modelgen.description.objects import Arm
from modelgen.effects import described
from modelgen.geometry import with_geometry_symbols
from modelgen.transmission import UNDRIVEN

GAINS = ("known", "estimated", "row_wise")
PARTS = ("drives", "effects")


@dataclass(frozen=True)
class Options:
    """How the functions are to be made.

    without: "drives" and "effects" to leave out. gains: one of GAINS (docs/theory.md, drive gains).
    runtime_geometry: lever geometry, joint offsets and the arm's symbols are an input. sincos: sines
    and cosines of the joint angles are inputs. jacobian_link: name of the link, by default the last.
    identified: values of the base parameters by name, to be folded in.
    """

    without: frozenset[str] = frozenset()
    gains: str = "known"
    runtime_geometry: bool = False
    sincos: bool = False
    jacobian_link: str | None = None
    identified: Mapping[str, float] = field(default_factory=dict)


def prepared(arm: Arm, options: Options) -> Arm:
    """The arm with drives or effects left out, and symbols in place of run-time geometry."""
    if "drives" in options.without:
        arm = replace(arm, joints=tuple(replace(joint, drive=UNDRIVEN) for joint in arm.joints))
    if "effects" in options.without:
        arm = arm.without_effects()
    arm = described(arm)
    return with_geometry_symbols(arm) if options.runtime_geometry else arm
