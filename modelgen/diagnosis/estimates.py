"""Values and standard deviations of what was found, from the whitened equations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from modelgen.description import Arm
from modelgen.diagnosis.causes import covariance, whitened_fit
from modelgen.diagnosis.objects import Estimate
from modelgen.diagnosis.rows import Array, Rows
from modelgen.diagnosis.selection import Selection
from modelgen.diagnosis.system import System
from modelgen.effects import CATALOGUE
from modelgen.functions import Model
from modelgen.model.parameters import unit_of
from modelgen.transmission import of_joint


def cause_estimates(selection: Selection, rows: Sequence[Rows], arm: Arm) -> list[dict[str, Estimate]]:
    """Of every cause, its own parameters. Values of what was searched for have no standard deviation."""
    system = selection.system
    whitened, spread = whitened_fit(system)
    place = rows[0].columns.shape[2]
    result = []
    for cause in selection.causes:
        trial = cause.trial
        k = trial.columns[0].shape[2]
        own = slice(place, place + k)
        std = dict(zip(trial.candidate.names, spread[own], strict=False))
        values = trial.parameters
        values |= {n: v for n, v in zip(trial.candidate.names, whitened[own], strict=False) if n in values}
        units = _units(arm, trial.candidate.effect, trial.candidate.joint)
        result.append(
            {
                name: Estimate(float(value), float(std.get(name, np.nan)), units.get(name, ""))
                for name, value in values.items()
            }
        )
        place += k
    return result


def _units(arm: Arm, effect: str, joint: int | None) -> dict[str, str]:
    coordinate = "m"
    if joint is not None:
        described = arm.joints[arm.coordinates[joint - 1]]
        drive = of_joint(arm, described)
        coordinate = "m" if described.type == "prismatic" else "rad"
        if CATALOGUE[effect].side == "motor" and drive.driven:
            coordinate = drive.unit
    return {p.name: unit_of(p.unit, coordinate) for p in CATALOGUE[effect].accepted()}


def base_estimates(model: Model, rows: Sequence[Rows], theta: Array) -> Mapping[str, Estimate]:
    """Base parameters of a model from its fit to rows; those that were known have no deviation."""
    system = System(rows, [r.columns for r in rows])
    baseline = rows[0].baseline
    spread = np.sqrt(np.maximum(0.0, np.diag(baseline.lift @ covariance(system) @ baseline.lift.T)))
    return {
        b.name: Estimate(float(v), float(s), b.unit)
        for b, v, s in zip(model.grouping.base, baseline.base(theta), spread, strict=True)
    }
