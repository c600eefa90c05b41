"""Forward selection of causes with backward elimination; each must pass every gate."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from modelgen.diagnosis.candidates import LATER, Candidate
from modelgen.diagnosis.rows import Array, Rows
from modelgen.diagnosis.system import System, rmse, weighted_fit
from modelgen.diagnosis.trials import Court, Trial, sensible
from modelgen.probing import Prober

EVIDENCE = 15.0  # delta BIC
PRACTICAL = 1.5  # percent of the RMSE on a record that the fit has not seen
AMBIGUOUS = 10.0  # delta BIC behind the winner
MOST = 4  # causes

Report = Callable[[str, int, int], None]


@dataclass
class Cause:
    """A candidate that passed. rivals: (candidate, delta BIC behind) that passed as well at its turn.

    delta_bic: what leaving it out of the final model costs; cross_gain: percent of the RMSE.
    """

    trial: Trial
    delta_bic: float
    cross_gain: float
    rivals: list[tuple[Trial, float]] = field(default_factory=list)


@dataclass(frozen=True)
class Selection:
    """The causes and the final system."""

    causes: list[Cause]
    system: System
    tried: int


def select(
    rows: Sequence[Rows],
    prober: Prober,
    pool: Sequence[Candidate],
    report: Report | None = None,
    evidence: float = EVIDENCE,
) -> Selection:
    """Causes in the order in which they were found."""
    baseline = [r.columns for r in rows]
    p = baseline[0].shape[2]
    causes: list[Cause] = []
    system = System(rows, baseline)
    for turn in range(MOST):
        court = Court(system, rows, prober, system.theta[:p])
        taken = {(c.trial.candidate.effect, c.trial.candidate.joint) for c in causes}
        trials: list[Trial] = []
        for k, candidate in enumerate(pool):
            if report is not None:
                report(f"cause {turn + 1}", k, len(pool))
            if (candidate.effect, candidate.joint) in taken:
                continue
            found = court.trial(candidate)
            if found is not None and found.gain.delta_bic >= evidence and sensible(found):
                trials.append(found)
        eligible = [
            (t, gain)
            for t in sorted(trials, key=lambda t: -t.gain.delta_bic)
            if (gain := passes(t, rows, [c.trial for c in causes])) is not None
        ]
        if not eligible:
            break
        best, gain = eligible[0]
        rivals = [
            (t, best.gain.delta_bic - t.gain.delta_bic)
            for t, _ in eligible[1:]
            if best.gain.delta_bic - t.gain.delta_bic <= AMBIGUOUS
        ]
        causes.append(Cause(best, best.gain.delta_bic, gain, rivals))
        system = System(rows, with_causes(rows, [c.trial for c in causes]))
    causes, system = _eliminated(causes, rows, system, evidence)
    return Selection(causes, system, len(pool))


def with_causes(rows: Sequence[Rows], trials: Sequence[Trial]) -> list[Array]:
    """Baseline and the causes' columns side by side, by record."""
    return [np.concatenate([r.columns, *(t.columns[i] for t in trials)], axis=2) for i, r in enumerate(rows)]


def _eliminated(
    causes: list[Cause], rows: Sequence[Rows], system: System, evidence: float
) -> tuple[list[Cause], System]:
    """Without causes that the others have made superfluous; evidence of the rest in the final model."""
    while len(causes) > 1:
        scores = [_worth(k, causes, rows) for k in range(len(causes))]
        worst = int(np.argmin(scores))
        if scores[worst] >= evidence:
            for cause, score in zip(causes, scores, strict=True):
                cause.delta_bic = score
            break
        del causes[worst]
        system = System(rows, with_causes(rows, [c.trial for c in causes]))
    return causes, system


def _worth(k: int, causes: Sequence[Cause], rows: Sequence[Rows]) -> float:
    """Delta BIC of cause k given all others."""
    others = [c.trial for i, c in enumerate(causes) if i != k]
    without = System(rows, with_causes(rows, others))
    trial = causes[k].trial
    gain = without.gain(trial.columns, float(len(trial.values)))
    return -np.inf if gain is None else gain.delta_bic


def passes(trial: Trial, rows: Sequence[Rows], before: Sequence[Trial]) -> float | None:
    """Percent of the RMSE gained on rows that the fit has not seen; None where a gate stays shut.

    Fitted on one part, tried on the other, and the other way round: the squares of all parts together.
    """
    later = trial.candidate.effect == LATER  # shows between records: halves of all are tried instead
    parts = [[0], [1]] if later else [[k] for k in range(len(rows))]
    old = with_causes(rows, before)
    new = with_causes(rows, [*before, trial])
    sums = np.zeros((2, rows[0].effort.shape[1]))
    for part in parts:
        if later:
            used, seen = _masked(rows, part[0])
            pairs = [(used, old, seen, old), (used, new, seen, new)]
        else:
            others = [k for k in range(len(rows)) if k not in part]
            used, seen = [rows[k] for k in others], [rows[k] for k in part]
            pairs = [(used, [c[k] for k in others], seen, [c[k] for k in part]) for c in (old, new)]
        for place, (fit_rows, fit_columns, test_rows, test_columns) in enumerate(pairs):
            theta = weighted_fit(fit_rows, fit_columns)
            counts = np.array([sum(r.moving[:, j].sum() for r in test_rows) for j in range(sums.shape[1])])
            sums[place] += rmse(test_rows, test_columns, theta) ** 2 * counts
    judged = trial.candidate.joints(sums.shape[1])
    gains = 100.0 * (1.0 - np.sqrt(sums[1, judged] / np.maximum(sums[0, judged], 1e-300)))
    gain = float(gains.max())
    whole = float(np.sqrt((sums[1] / np.maximum(sums[0], 1e-300)).mean()))
    return gain if gain >= PRACTICAL and whole < 1.0 else None


def _masked(rows: Sequence[Rows], half: int) -> tuple[list[Rows], list[Rows]]:
    """All records with one half of each to fit, the other to try."""
    first, second = [], []
    for r in rows:
        flags = np.zeros(len(r.effort), dtype=bool)
        flags[: len(flags) // 2] = True
        first.append(Rows(r.prepared, r.effort, r.columns, r.moving & flags[:, None]))
        second.append(Rows(r.prepared, r.effort, r.columns, r.moving & ~flags[:, None]))
    return (first, second) if half == 0 else (second, first)
