"""Estimates as they are reported: of the causes' parameters and of the arm's, with their deviations."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from modelgen.description import Arm
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.evidence import System
from modelgen.diagnosis.extended.findings import Estimate
from modelgen.diagnosis.selection import Selection, covariance_of, deviations
from modelgen.effects import CATALOGUE
from modelgen.functions import Model
from modelgen.model.parameters import unit_of
from modelgen.numeric import Array
from modelgen.transmission import of_joint


def valued(selection: Selection) -> Selection:
    """The selection with the values of its causes as the extended model is fitted: by the plain equations."""
    causes = []
    for cause, own in zip(selection.causes, selection.columns, strict=True):
        trial, values = cause.trial, selection.system.theta[own]
        if not trial.candidate.elastic:  # which are as they were simulated
            values = np.where(trial.candidate.positive, np.maximum(values, 0.0), values)
            trial = replace(trial, gain=replace(trial.gain, values=values))
        causes.append(replace(cause, trial=trial))
    return replace(selection, causes=causes)


def cause_estimates(selection: Selection, equations: Equations) -> list[dict[str, Estimate]]:
    """Estimates of the causes' own parameters; what was fixed, is not determined or hangs on a guess has no
    deviation.
    """
    most = equations.thresholds.extended.max_relative_deviation
    found = []
    for cause, spread in zip(selection.causes, deviations(selection, equations), strict=True):
        units = units_at(equations.arm, *cause.trial.candidate.place)
        values, searched = cause.trial.parameters, cause.trial.values
        c = cause.trial.candidate
        open_ = {*c.definition.conditional(c.fixed)}
        open_ |= {name for name in searched if name in values and spread[name] > most * abs(values[name])}
        found.append(
            {
                name: Estimate(v, float("nan") if name in open_ else spread[name], units.get(name, ""))
                for name, v in values.items()
            }
        )
    return found


def units_at(arm: Arm, effect: str, joint: int | None) -> dict[str, str]:
    """Units of an effect's parameters by name, at a coordinate (from 1) or for the whole arm."""
    coordinate = "m"
    if joint is not None:
        described = arm.joints[arm.coordinates[joint - 1]]
        drive = of_joint(arm, described)
        coordinate = described.unit
        if CATALOGUE[effect].side == "motor" and drive.driven:
            coordinate = drive.unit
    return {p.name: unit_of(p.unit, coordinate) for p in CATALOGUE[effect].accepted()}


def base_estimates(model: Model, theta: Array, equations: Equations) -> Mapping[str, Estimate]:
    """Base parameters of a model from its fit; those that were known have no deviation. theta: unknowns (k,)
    of its equations.
    """
    system, rows = System(equations), equations.rows
    lift = rows[0].baseline.lift
    spread = np.sqrt(np.maximum(0.0, np.diag(lift @ covariance_of(system) @ lift.T)))
    return {
        b.name: Estimate(float(v), float(s), b.unit)
        for b, v, s in zip(model.grouping.base, rows[0].baseline.base(theta), spread, strict=True)
    }
