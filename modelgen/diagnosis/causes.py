"""Causes that were taken, and which of them the others make superfluous."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from modelgen.diagnosis.gates import Gates, with_causes
from modelgen.diagnosis.rows import Array, Rows
from modelgen.diagnosis.system import System
from modelgen.diagnosis.trials import Trial

CONTRADICTION = 3.0  # standard deviations below zero, of what cannot be negative


@dataclass
class Cause:
    """A candidate that passed. rivals: (candidate, delta BIC behind) that passed as well at its turn.

    delta_bic: what leaving it out of the final model costs; cross_gain, expected_gain: percent of the RMSE on
    rows that its fit had not seen, as measured and as it must be if the cause is there as found.
    """

    trial: Trial
    delta_bic: float
    cross_gain: float
    expected_gain: float
    rivals: list[tuple[Trial, float]] = field(default_factory=list)


def eliminated(
    causes: list[Cause],
    rows: Sequence[Rows],
    system: System,
    evidence: float,
    blur: Array | None,
    narrowed: float,
) -> tuple[list[Cause], System]:
    """Without causes that the others have made superfluous: those that lack evidence, then those whose value
    is not possible, then those that gain nothing, in the final model. Evidence of the rest in that model.
    """
    while len(causes) > 1:
        scores = [_worth(k, causes, system) for k in range(len(causes))]
        worst = int(np.argmin(scores))
        if scores[worst] >= evidence:
            for cause, score in zip(causes, scores, strict=True):
                cause.delta_bic = score
            signs = [_least_value(k, causes, system) for k in range(len(causes))]
            worst = int(np.argmin(signs))
            if signs[worst] >= -CONTRADICTION:
                gains = [_gain(k, causes, system, blur, narrowed) for k in range(len(causes))]
                worst = int(np.argmin(gains))
                if gains[worst] > 0.0:
                    break
        del causes[worst]
        system = System(rows, with_causes(rows, [c.trial for c in causes]), system.periods)
    return causes, system


def _gain(k: int, causes: Sequence[Cause], system: System, blur: Array | None, narrowed: float) -> float:
    """Expected gain of cause k given all others, in percent; zero where a gate stays shut."""
    others = [c.trial for i, c in enumerate(causes) if i != k]
    without = System(system.rows, with_causes(system.rows, others), system.periods)
    found = Gates(system.rows, others, without, blur, narrowed, last=True).judged(causes[k].trial)
    return 0.0 if found.refused else max(found.expected, found.gain)


def _worth(k: int, causes: Sequence[Cause], system: System) -> float:
    """Delta BIC of cause k given all others."""
    others = [c.trial for i, c in enumerate(causes) if i != k]
    without = System(system.rows, with_causes(system.rows, others), system.periods)
    trial = causes[k].trial
    gain = without.gain(trial.columns, float(len(trial.values)), trial.candidate.positive)
    return -np.inf if gain is None else gain.delta_bic


def _least_value(k: int, causes: Sequence[Cause], system: System) -> float:
    """Of what may not be negative in cause k, the least value in the whitened equations, in its standard
    deviations; zero where there is nothing of the kind.
    """
    limited = np.array(causes[k].trial.candidate.positive, dtype=bool)
    shown = np.array([any(c[:, :, i].any() for c in causes[k].trial.columns) for i in range(len(limited))])
    begin = system.rows[0].columns.shape[2] + sum(c.trial.columns[0].shape[2] for c in causes[:k])
    places = begin + np.flatnonzero(limited & shown)
    values = np.linalg.lstsq(system.matrix, system.right, rcond=1e-12)[0][places]
    spread = np.sqrt(np.maximum(np.diag(covariance(system))[places], 1e-300))
    return float((values / spread).min(initial=0.0))


def covariance(system: System) -> Array:
    """Of the least squares solution of the whitened equations, (p, p)."""
    norms = np.linalg.norm(system.matrix, axis=0)
    norms[norms == 0] = 1.0
    inverse = np.linalg.pinv((system.matrix / norms).T @ (system.matrix / norms), rcond=1e-14)
    return np.asarray(inverse / np.outer(norms, norms))
