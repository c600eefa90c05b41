"""Causes that were chosen, and which of them the others make superfluous."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modelgen.diagnosis.candidates import FittedCandidate, beside, system_of
from modelgen.diagnosis.evidence import System, whitened_fit
from modelgen.diagnosis.selection.cause import Cause
from modelgen.diagnosis.validation import Conditions


def backward_elimination(causes: list[Cause], system: System, evidence: float) -> tuple[list[Cause], System]:
    """Leave out causes that others have made superfluous: those that lack evidence, then those whose value
    is not possible, then those that gain nothing, in the final model. Evidence of the rest in that model.

    system: with all causes; evidence: delta BIC that it takes to name one.
    """
    equations = system.equations
    most = equations.thresholds.selection.max_sign_deviations
    while len(causes) > 1:
        rest = [[c.trial for c in causes if c is not cause] for cause in causes]
        without = [system_of(equations, others) for others in rest]
        scores = [_worth(c.trial, s) for c, s in zip(causes, without, strict=True)]
        worst = int(np.argmin(scores))
        if scores[worst] >= evidence:
            for cause, score in zip(causes, scores, strict=True):
                cause.delta_bic = score
            signs = _least_values(causes, system)
            worst = int(np.argmin(signs))
            if signs[worst] >= -most:
                conditions = [
                    Conditions(s, others, last=True) for others, s in zip(rest, without, strict=True)
                ]
                gains = [_gain(c.trial, g) for c, g in zip(causes, conditions, strict=True)]
                worst = int(np.argmin(gains))
                if gains[worst] > 0.0:
                    break
        del causes[worst]
        system = system_of(equations, [c.trial for c in causes])
    return causes, system


def measured(cause: Cause, causes: Sequence[Cause], system: System) -> Cause:
    """The cause with its evidence and gains beside all others. system: with all of them."""
    others = [c.trial for c in causes if c is not cause]
    without = system_of(system.equations, others)
    by = Conditions(without, others, last=True).judged(cause.trial)
    return replace(
        cause, delta_bic=_worth(cause.trial, without), cross_gain=by.gain, expected_gain=by.expected
    )


def _gain(trial: FittedCandidate, conditions: Conditions) -> float:
    """Expected gain given all others, in percent; zero where one of them fails."""
    found = conditions.judged(trial)
    return 0.0 if found.refused else max(found.expected, found.gain)


def _worth(trial: FittedCandidate, without: System) -> float:
    """Delta BIC given all others."""
    gain = beside(trial, without)
    return -np.inf if gain is None else gain.delta_bic - trial.prior_penalty


def _least_values(causes: Sequence[Cause], system: System) -> list[float]:
    """Least value in each cause of what may not be negative, in the whitened equations, in its standard
    deviations; zero where there is nothing of the kind.
    """
    values, spread = whitened_fit(system)
    begin, found = system.rows[0].columns.shape[2], []
    for cause in causes:
        columns = cause.trial.columns
        shown = np.any([c.any(axis=(0, 1)) for c in columns], axis=0)
        places = begin + np.flatnonzero(np.array(cause.trial.candidate.positive, dtype=bool) & shown)
        found.append(float((values[places] / np.maximum(spread[places], 1e-150)).min(initial=0.0)))
        begin += columns[0].shape[2]
    return found
