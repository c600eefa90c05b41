"""Estimates as they are reported: of the causes' parameters and of the arm's, with their deviations."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.evidence import System
from modelgen.diagnosis.extended.findings import Estimate
from modelgen.diagnosis.selection import Selection, covariance_of, deviations, unseparated
from modelgen.functions import Model
from modelgen.model.parameters import units_at
from modelgen.numeric import Array


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
    alike = unseparated(selection, equations)
    for cause, spread, held in zip(selection.causes, deviations(selection, equations), alike, strict=True):
        units = units_at(equations.arm, *cause.trial.candidate.place)
        values, searched = cause.trial.parameters, cause.trial.values
        c = cause.trial.candidate
        open_ = {*c.definition.conditional(c.fixed)}
        open_ |= {name for name in searched if name in values and spread[name] > most * abs(values[name])}
        found.append(
            {
                name: Estimate(
                    v, float("nan") if name in open_ else spread[name], units.get(name, ""), name not in held
                )
                for name, v in values.items()
            }
        )
    return found


def base_estimates(model: Model, theta: Array, equations: Equations) -> Mapping[str, Estimate]:
    """Base parameters of a model from its fit; those that were known have no deviation. theta: unknowns (k,)
    of its equations.
    """
    system, rows = System(equations), equations.rows
    lift = rows[0].baseline.lift
    spread = np.sqrt(np.maximum(0.0, np.diag(lift @ covariance_of(system) @ lift.T)))
    return {
        b.name: Estimate(float(v), float(s) if s > 0.0 else float("nan"), b.unit)
        for b, v, s in zip(model.grouping.base, rows[0].baseline.base(theta), spread, strict=True)
    }
