"""Values and standard deviations of what was found, as the extended model is fitted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from modelgen.description import Arm
from modelgen.diagnosis.deviations import covariance_of, deviations
from modelgen.diagnosis.objects import Estimate
from modelgen.diagnosis.rows import Rows
from modelgen.diagnosis.selection import Selection
from modelgen.diagnosis.system import System
from modelgen.effects import CATALOGUE
from modelgen.functions import Model
from modelgen.model.parameters import unit_of
from modelgen.numeric import Array
from modelgen.probing import Prober
from modelgen.transmission import of_joint


def cause_estimates(selection: Selection, prober: Prober) -> list[dict[str, Estimate]]:
    """Of every cause, its own parameters; what was fixed, or is not determined, has no deviation."""
    found = []
    for cause, spread in zip(selection.causes, deviations(selection, prober), strict=True):
        units = _units(prober.arm, *cause.trial.candidate.place)
        values = cause.trial.parameters
        found.append({name: Estimate(v, spread[name], units.get(name, "")) for name, v in values.items()})
    return found


def _units(arm: Arm, effect: str, joint: int | None) -> dict[str, str]:
    coordinate = "m"
    if joint is not None:
        described = arm.joints[arm.coordinates[joint - 1]]
        drive = of_joint(arm, described)
        coordinate = "m" if described.type == "prismatic" else "rad"
        if CATALOGUE[effect].side == "motor" and drive.driven:
            coordinate = drive.unit
    return {p.name: unit_of(p.unit, coordinate) for p in CATALOGUE[effect].accepted()}


def base_estimates(
    model: Model, rows: Sequence[Rows], theta: Array, periods: Sequence[int | None]
) -> Mapping[str, Estimate]:
    """Base parameters of a model from its fit to rows; those that were known have no deviation. periods: rows
    in a period of each record.
    """
    system = System(rows, [r.columns for r in rows], periods)
    lift = rows[0].baseline.lift
    spread = np.sqrt(np.maximum(0.0, np.diag(lift @ covariance_of(system) @ lift.T)))
    return {
        b.name: Estimate(float(v), float(s), b.unit)
        for b, v, s in zip(model.grouping.base, rows[0].baseline.base(theta), spread, strict=True)
    }
