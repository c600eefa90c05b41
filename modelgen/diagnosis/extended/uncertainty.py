"""Estimates as they are reported: of the causes' parameters and of the arm's, with their deviations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from modelgen.diagnosis.candidates import at_ends
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.evidence import System
from modelgen.diagnosis.extended.cause_values import own_parameters
from modelgen.diagnosis.extended.extended_model import Extension, FittedModel
from modelgen.diagnosis.extended.findings import Estimate
from modelgen.diagnosis.selection import Selection, Spread, covariance_of, unseparated
from modelgen.model.parameters import units_at
from modelgen.numeric import Array


def cause_estimates(selection: Selection, equations: Equations, spread: Spread) -> list[dict[str, Estimate]]:
    """Estimates of the causes' own parameters; what was fixed, is not determined, is at an end of its search
    or hangs on a guess has no deviation. spread: `deviations` of the selection.
    """
    most = equations.thresholds.extended.max_relative_deviation
    found = []
    alike = unseparated(selection, equations)
    for cause, own, held in zip(selection.causes, spread.causes, alike, strict=True):
        units = units_at(equations.arm, *cause.trial.candidate.place)
        values, searched = cause.trial.parameters, cause.trial.values
        c = cause.trial.candidate
        open_ = {*c.definition.conditional(c.fixed)}
        open_ |= {name for name in searched if name in values and own[name] > most * abs(values[name])}
        open_ |= at_ends(c, searched, equations)
        found.append(
            {
                name: Estimate(
                    v, float("nan") if name in open_ else own[name], units.get(name, ""), name not in held
                )
                for name, v in values.items()
            }
        )
    return found


def base_estimates(
    extension: Extension, spread: Spread, causes: Sequence[Mapping[str, Estimate]], covariance: Array
) -> Mapping[str, Estimate]:
    """Base parameters of the extended model; those that were known have no deviation.

    spread: `deviations` of its causes and of the arm's parameters beside them. causes: estimates of the
    causes' parameters, which those that are base parameters have here too. What another model would group
    otherwise has the deviation of its own fit. covariance: (p, p), `covariance_of_base` of that model.
    """
    after, equations = extension.after, extension.equations
    own = np.sqrt(np.maximum(0.0, np.diag(covariance)))
    lift = equations.rows[0].baseline.lift
    described = equations.model.grouping.base
    shared = np.sqrt(np.maximum(0.0, np.diag(lift @ spread.arm @ lift.T)))
    beside = {(b.name, b.expression): float(s) for b, s in zip(described, shared, strict=True)}
    found = {
        b.name: Estimate(float(v), beside.get((b.name, b.expression), float(s)), b.unit)
        for b, v, s in zip(after.model.grouping.base, after.parameters, own, strict=True)
    }
    names = [b.name for b in after.model.grouping.base]
    for p in own_parameters(after.model, [c.trial for c in extension.selection.causes]):
        found[names[p.base]] = replace(causes[p.cause][p.name], separate=True)
    return {name: replace(e, std=e.std if e.std > 0.0 else float("nan")) for name, e in found.items()}


def covariance_of_base(fitted: FittedModel, equations: Equations) -> Array:
    """Covariance (p, p) of a model's base parameters in the equations of its own; zero of what was known."""
    lift = fitted.rows[0].baseline.lift
    return np.asarray(lift @ covariance_of(System(equations.with_rows(fitted.rows))) @ lift.T)
