"""Forward selection of causes with backward elimination; each must pass every gate."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from modelgen.diagnosis.candidates import COMPLIANT, LATER, Candidate
from modelgen.diagnosis.endogeneity import endogeneity
from modelgen.diagnosis.instruments import Pairs
from modelgen.diagnosis.positions import feigned, repeating_errors
from modelgen.diagnosis.rows import Array, Rows
from modelgen.diagnosis.system import System, mean_squares, rmse, weighted_fit
from modelgen.diagnosis.trials import Court, Trial, sensible
from modelgen.probing import Prober

EVIDENCE = 15.0  # delta BIC
PRACTICAL = 1.5  # percent of the RMSE on a record that the fit has not seen
DELAYED = 3.0  # the same for a delay: sticking at reversals leaves a share of a sample
AMBIGUOUS = 10.0  # delta BIC behind the winner
MOST = 4  # causes, or one for each joint where there are more
FEW = 4  # records that are tried one by one
SIGNIFICANT = 6.0  # standard deviations of an estimate by instruments

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
class Ranked:
    """A candidate's evidence at one turn, and why it was not taken: empty for what passed every gate.

    cross_gain: percent of the RMSE on rows that its fit had not seen, None where that was not asked.
    """

    effect: str
    joint: int | None
    delta_bic: float
    cross_gain: float | None
    refused: str


@dataclass(frozen=True)
class Selection:
    """The causes and the final system. turns: all candidates with evidence, best first, by turn."""

    causes: list[Cause]
    system: System
    turns: list[list[Ranked]]


def select(
    rows: Sequence[Rows],
    prober: Prober,
    pool: Sequence[Candidate],
    periods: Sequence[int | None],
    report: Report | None = None,
    evidence: float = EVIDENCE,
    blur: Array | None = None,
    narrowed: float = 1.0,
) -> Selection:
    """Causes in the order in which they were found. blur: what errors of the positions leave in the
    residuals, mean squares by joint (n,): a cause must explain more than they could feign. narrowed: the
    usual band over that of the rows, where coarse positions asked for a narrower one.
    """
    baseline = [r.columns for r in rows]
    p = baseline[0].shape[2]
    causes: list[Cause] = []
    system = System(rows, baseline, periods)
    known: dict[object, list[Array] | None] = {}
    correlated = endogeneity(system)
    noisy = correlated is not None and correlated.found and float(correlated.share.max()) > PRACTICAL
    noisy = noisy and not repeating_errors(rows, periods).any()  # those of known steps: `blur` is their price
    turns: list[list[Ranked]] = []
    for turn in range(max(MOST, rows[0].effort.shape[1])):
        court = Court(system, rows, prober, rows[0].baseline.base(system.theta[:p]), known)
        taken = {(c.trial.candidate.effect, c.trial.candidate.joint) for c in causes}
        trials: list[Trial] = []
        ranking: list[Ranked] = []
        for k, candidate in enumerate(pool):
            if report is not None:
                report(f"cause {turn + 1}", k, len(pool))
            if (candidate.effect, candidate.joint) in taken:
                continue
            found = court.trial(candidate)
            if found is None:
                continue
            if found.gain.delta_bic < evidence:
                ranking.append(_ranked(found, None, "evidence"))
            elif not sensible(found, prober.arm):
                ranking.append(_ranked(found, None, "values"))
            else:
                trials.append(found)
        eligible: list[tuple[Trial, float]] = []
        for t in sorted(trials, key=lambda t: -t.gain.delta_bic):
            gain, refused = judged(t, rows, [c.trial for c in causes], blur, system, narrowed)
            if noisy and not refused and not instrumented(t, system):
                refused = "positions"
            ranking.append(_ranked(t, gain, refused))
            if not refused:
                eligible.append((t, gain))
        turns.append(sorted(ranking, key=lambda r: -r.delta_bic))
        if not eligible:
            break
        best, gain = eligible[0]
        rivals = [
            (t, best.gain.delta_bic - t.gain.delta_bic)
            for t, other in eligible[1:]
            if best.gain.delta_bic - t.gain.delta_bic <= AMBIGUOUS
            or 100.0 * (gain - other) / (100.0 - other) <= _margin(best, gain, system, blur)
        ]
        causes.append(Cause(best, best.gain.delta_bic, gain, rivals))
        system = System(rows, with_causes(rows, [c.trial for c in causes]), periods)
    causes, system = _eliminated(causes, rows, system, evidence)
    named = {(c.trial.candidate.effect, c.trial.candidate.joint) for c in causes}
    for cause in causes:  # what is there beside it does not stand for it
        cause.rivals = [r for r in cause.rivals if (r[0].candidate.effect, r[0].candidate.joint) not in named]
    return Selection(causes, system, turns)


def _ranked(t: Trial, gain: float | None, refused: str) -> Ranked:
    return Ranked(t.candidate.effect, t.candidate.joint, t.gain.delta_bic, gain, refused)


def _margin(best: Trial, gain: float, system: System, blur: Array | None) -> float:
    """Percent of what a rival leaves by which errors of coarse positions can put the best before it."""
    if blur is None:
        return -np.inf
    left = mean_squares(system) * (1.0 - gain / 100.0) ** 2
    found = float(feigned(blur, left)[best.candidate.joints(system.n)].max())
    return found if found > PRACTICAL else -np.inf


def with_causes(rows: Sequence[Rows], trials: Sequence[Trial]) -> list[Array]:
    """Baseline and the causes' columns side by side, by record."""
    return [np.concatenate([r.columns, *(t.columns[i] for t in trials)], axis=2) for i, r in enumerate(rows)]


def _eliminated(
    causes: list[Cause], rows: Sequence[Rows], system: System, evidence: float
) -> tuple[list[Cause], System]:
    """Without causes that the others have made superfluous; evidence of the rest in the final model."""
    while len(causes) > 1:
        scores = [_worth(k, causes, system) for k in range(len(causes))]
        worst = int(np.argmin(scores))
        if scores[worst] >= evidence:
            for cause, score in zip(causes, scores, strict=True):
                cause.delta_bic = score
            break
        del causes[worst]
        system = System(rows, with_causes(rows, [c.trial for c in causes]), system.periods)
    return causes, system


def _worth(k: int, causes: Sequence[Cause], system: System) -> float:
    """Delta BIC of cause k given all others."""
    others = [c.trial for i, c in enumerate(causes) if i != k]
    without = System(system.rows, with_causes(system.rows, others), system.periods)
    trial = causes[k].trial
    gain = without.gain(trial.columns, float(len(trial.values)))
    return -np.inf if gain is None else gain.delta_bic


def judged(
    trial: Trial,
    rows: Sequence[Rows],
    before: Sequence[Trial],
    blur: Array | None = None,
    system: System | None = None,
    narrowed: float = 1.0,
) -> tuple[float, str]:
    """Percent of the RMSE gained on rows that the cause's fit has not seen, and the gate that stays shut.

    The cause is fitted on one part and carried to the other, where the rest of the model is fitted anew
    with and without it; then the other way round. The squares of all parts count together. A part is a
    record, or every other one of many: a short record alone cannot hold the rest of the model.
    A gain must be more than errors of the positions could feign (`blur`), or the estimate by instruments
    not zero.
    """
    later = trial.candidate.effect == LATER  # shows between records: halves of all are tried instead
    n = rows[0].effort.shape[1]
    sums, counts = np.zeros((2, n)), np.zeros(n)
    parts = [[i] for i in range(len(rows))]
    if len(rows) > FEW:
        parts = [list(range(k, len(rows), 2)) for k in range(2)]
    for k in range(2 if later else len(parts)):
        if later:
            fitted, tried = _masked(rows, k)
            places = list(range(len(rows))), list(range(len(rows)))
        else:
            others = [i for i in range(len(rows)) if i not in parts[k]]
            fitted, tried, places = [rows[i] for i in others], [rows[i] for i in parts[k]], (others, parts[k])
        old, new = with_causes(rows, before), with_causes(rows, [*before, trial])
        theta = weighted_fit(fitted, [new[i] for i in places[0]])[old[0].shape[2] :]
        carried = [
            replace(r, effort=r.effort - trial.columns[i] @ theta)
            for r, i in zip(tried, places[1], strict=True)
        ]
        table = [old[i] for i in places[1]]
        moving = np.sum([r.moving.sum(axis=0) for r in tried], axis=0)
        sums[0] += moving * rmse(tried, table, weighted_fit(tried, table)) ** 2
        sums[1] += moving * rmse(carried, table, weighted_fit(carried, table)) ** 2
        counts += moving
    ratio = np.sqrt(sums[1] / np.maximum(sums[0], 1e-300))[counts > 0]
    judged = [j for j in trial.candidate.joints(n) if counts[j] > 0]
    gains = 100.0 * (1.0 - np.sqrt(sums[1, judged] / np.maximum(sums[0, judged], 1e-300)))
    worth = practical(DELAYED if trial.candidate.effect == "time_delay" else PRACTICAL, narrowed)
    least = np.full(len(judged), worth)
    if blur is not None and (gains >= least).any() and not (system and instrumented(trial, system)):
        least = np.maximum(least, feigned(blur[judged], sums[0, judged] / counts[judged]))
    best = float(gains[gains >= least].max(initial=-np.inf))
    if not np.isfinite(best):
        most = float(gains.max(initial=-np.inf))
        return most, "gain" if (gains < worth).all() or blur is None else "positions"
    return best, "" if float((ratio**2).mean()) < 1.0 else "other joints"


def practical(percent: float, narrowed: float) -> float:
    """Percent of the RMSE in a narrowed band that is `percent` in the usual one.

    A band `narrowed` times as wide has that many times the power of white noise, and the cause as much as
    before: what is worth naming does not become less for being seen better.
    """
    odds = narrowed * ((1.0 - percent / 100.0) ** -2 - 1.0)  # power of the cause over that of the noise
    return 100.0 * (1.0 - float((1.0 + odds) ** -0.5))


def instrumented(trial: Trial, system: System) -> bool:
    """Whether the cause's estimate differs from zero where instruments keep errors of the positions out."""
    if trial.candidate.effect in (LATER, "friction_warm_up"):  # do not repeat
        return False
    if trial.candidate.effect in COMPLIANT:  # searched for over what makes a filter of any errors
        return False
    table = [np.concatenate([c, t], axis=2) for c, t in zip(system.columns, trial.columns, strict=True)]
    pairs = Pairs(system.rows, table, system.periods, system.plain.sizes)
    if not pairs.enough or repeating_errors(system.rows, system.periods).any():
        return False
    values = pairs.t_values(system.plain.share)[system.columns[0].shape[2] :]
    return bool(np.abs(values).max(initial=0.0) > SIGNIFICANT)


def _masked(rows: Sequence[Rows], half: int) -> tuple[list[Rows], list[Rows]]:
    """All records with one half of each to fit, the other to try."""
    first, second = [], []
    for r in rows:
        flags = np.zeros(len(r.effort), dtype=bool)
        flags[: len(flags) // 2] = True
        first.append(replace(r, moving=r.moving & flags[:, None]))
        second.append(replace(r, moving=r.moving & ~flags[:, None]))
    return (first, second) if half == 0 else (second, first)
