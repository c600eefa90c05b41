"""Forward selection of causes with backward elimination; each must pass every gate."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from modelgen.description import Arm
from modelgen.diagnosis.candidates.candidate import Candidate, without_rests
from modelgen.diagnosis.candidates.fitted import FittedCandidate, beside, sensible
from modelgen.diagnosis.candidates.pool import fit_pool
from modelgen.diagnosis.candidates.search import Columns, Search
from modelgen.diagnosis.equations.position_errors import feigned, harmless, repeating_errors
from modelgen.diagnosis.equations.rows import Rows
from modelgen.diagnosis.evidence.instruments import endogeneity
from modelgen.diagnosis.evidence.system import System, mean_squares
from modelgen.diagnosis.selection.backward import backward_elimination, measured
from modelgen.diagnosis.selection.cause import Cause, Selection
from modelgen.diagnosis.selection.compliance import alternatives, member, refine, refined
from modelgen.diagnosis.selection.exchange import exchanged
from modelgen.diagnosis.selection.history import (
    EXCHANGED,
    SUPERFLUOUS,
    History,
    Ranked,
    best_of_each,
    ranked,
    taken_back,
)
from modelgen.diagnosis.selection.refit import refit
from modelgen.diagnosis.thresholds import (
    ALONE,
    COLOURLESS,
    EVIDENCE,
    PASSING,
    PRACTICAL,
    RATHER,
    STAYS,
)
from modelgen.diagnosis.validation.form_error import with_causes
from modelgen.diagnosis.validation.gates import Gates, Judgement, instrumented
from modelgen.evaluation import Evaluator
from modelgen.jobs import HERE, Where
from modelgen.numeric import Array

FORM = 0.03  # of its evidence, between play and elasticity: a real gear has the form of neither
ALIKE = 0.7  # of the gain that one joint promises alone: what is in all drives alike promises as much there
MOST = 4  # causes, or two for each joint where these are more
Report = Callable[[str, int, int], None]


def forward_selection(
    rows: Sequence[Rows],
    evaluator: Evaluator,
    pool: Sequence[Candidate],
    periods: Sequence[int | None],
    report: Report | None = None,
    blur: Array | None = None,
    narrowed: float = 1.0,
    where: Where = HERE,
) -> Selection:
    """Causes in the order in which they were found. blur: what errors of the positions leave in the
    residuals, mean squares by joint (n,): a cause must explain more than they could feign. narrowed: the
    usual band over that of the rows, where coarse positions asked for a narrower one. where: processes among
    which the candidates are shared.
    """
    baseline = [r.columns for r in rows]
    p = baseline[0].shape[2]
    causes: list[Cause] = []
    system = System(rows, baseline, periods)
    evidence = threshold(system)
    known: Columns = {}
    steps = repeating_errors(rows, periods).any()  # errors of a known size: `blur` is their price
    turns: History = []
    for turn in range(max(MOST, 2 * rows[0].effort.shape[1])):
        noisy = not (steps or _harmless(rows, blur, system)) and correlated(system)
        elastic = {c.trial.candidate.joint for c in causes if c.trial.candidate.elastic}
        search = Search(system, rows, evaluator, rows[0].baseline.base(system.theta[:p]), known, elastic)
        taken = {c.trial.candidate.place for c in causes}
        left = [c for c in pool if c.place not in taken]
        told = None if report is None else partial(report, f"cause {turn + 1}")
        trials, faint, ranking = _weighed(fit_pool(left, search, where, told), evidence, evaluator.arm)
        settled = refined(trials, causes, system, rows, evaluator, where)
        gates = Gates(rows, [c.trial for c in causes], system, blur, narrowed)
        weighed: list[tuple[FittedCandidate, Judgement]] = []
        for t in sorted([*trials, *settled], key=lambda t: -t.odds):
            judged = gates.judged(t)
            if noisy and not judged.refused and not instrumented(t, system):
                together = with_causes(rows, [*(c.trial for c in causes), t])
                # behind an elastic joint a link swings otherwise in every period, as errors do
                if not t.candidate.elastic or correlated(System(rows, together, periods)):
                    judged = replace(judged, refused="positions")
            weighed.append((t, judged))
        passed = [pair for pair in weighed if not pair[1].refused]
        weighed = [
            (t, by if by.refused else replace(by, refused=_given_way((t, by), passed))) for t, by in weighed
        ]
        eligible = [pair for pair in weighed if not pair[1].refused]
        ranking += [ranked(t, judged, judged.refused) for t, judged in weighed]
        if not eligible:
            turns.append(best_of_each(ranking, None))
            break
        best, by = member(eligible[0], eligible)
        turns.append(best_of_each(ranking, best.candidate.place))
        margin = _margin(best, by.gain, system, blur)
        rivals = [
            (t, max(0.0, best.gain.delta_bic - t.gain.delta_bic))
            for t, other in eligible
            if t.candidate != best.candidate
            and (
                best.gain.delta_bic - t.gain.delta_bic <= needed_behind(best, t)
                or 100.0 * (by.gain - other.gain) / (100.0 - other.gain) <= margin
            )
        ]
        lesser = lesser_rivals(best, faint, gates)
        own = [t for t in settled if t.candidate == best.candidate]
        causes.append(Cause((own or [best])[0], best.gain.delta_bic, by.gain, by.expected, rivals, lesser))
        rows = without_rests(rows, best.candidate)
        refit(causes, rows, evaluator)
        if not own:
            refine(causes, rows, evaluator)
        system = System(rows, with_causes(rows, [c.trial for c in causes]), periods)
    better = exchanged(causes, rows, evaluator, periods)
    if better is not causes:
        for old, new in zip(causes, better, strict=True):
            place = new.trial.candidate.place
            if place != old.trial.candidate.place:
                turns = taken_back(turns, old.trial.candidate.place, EXCHANGED, place)
        system = System(rows, with_causes(rows, [c.trial for c in better]), periods)
        causes = [
            new
            if new.trial.candidate == old.trial.candidate
            else measured(new, better, rows, system, blur, narrowed)
            for new, old in zip(better, causes, strict=True)
        ]
    every = causes[:]
    causes, system = backward_elimination(causes, rows, system, evidence, blur, narrowed)
    if len(causes) < len(every):
        for lost in (c for c in every if all(c is not kept for kept in causes)):
            turns = taken_back(turns, lost.trial.candidate.place, SUPERFLUOUS)
        refit(causes, rows, evaluator)
        system = System(rows, with_causes(rows, [c.trial for c in causes]), periods)
    named = {c.trial.candidate.place for c in causes}
    for cause in causes:  # what is there beside it, or could be, does not stand for it
        others = {t.candidate.place: (t, by) for t, by in reversed([*cause.rivals, *cause.lesser])}
        rivals = [r for place, r in reversed(others.items()) if place not in named]
        cause.rivals = [(t, behind) for t, behind in rivals if left_to(t, system) < STAYS * t.gain.delta_bic]
    return Selection(causes, system, turns)


def _weighed(
    every: Sequence[FittedCandidate | None], evidence: float, arm: Arm
) -> tuple[list[FittedCandidate], list[FittedCandidate], list[Ranked]]:
    """Candidates with evidence, those with too little of it, and what evidence or values refuse."""
    trials, faint, refused = [], [], []
    for found in every:
        if found is None:
            continue
        if found.gain.delta_bic < max(least_evidence(found), evidence):
            refused.append(ranked(found, None, "evidence"))
            if found.gain.delta_bic > 0 and sensible(found, arm):
                faint.append(found)
        elif not sensible(found, arm):
            refused.append(ranked(found, None, "values"))
        else:
            trials.append(found)
    return trials, faint, refused


def lesser_rivals(
    best: FittedCandidate, faint: Sequence[FittedCandidate], gates: Gates
) -> list[tuple[FittedCandidate, float]]:
    """Rivals of the best that cannot be named themselves and may be what is there all the same: of too little
    evidence, where the best has little more.
    """
    behind = [(t, best.gain.delta_bic - t.gain.delta_bic) for t in faint]
    near = [(t, max(0.0, by)) for t, by in behind if by <= RATHER and t.candidate != best.candidate]
    return [(t, by) for t, by in near if not gates.judged(t).refused]


def least_evidence(trial: FittedCandidate) -> float:
    """Delta BIC that it takes to name this cause where the noise is known."""
    if trial.gain.rank + len(trial.candidate.searched) == 1:
        return ALONE
    return PASSING if trial.candidate.passing else EVIDENCE


def threshold(system: System) -> float:
    """Delta BIC that it takes to name a cause."""
    return EVIDENCE if system.coloured else COLOURLESS


def needed_behind(best: FittedCandidate, other: FittedCandidate) -> float:
    """Delta BIC by which a rival must be behind to be none."""
    of_it = FORM if alternatives(best.candidate, other.candidate) else 0.0
    return max(RATHER, of_it * best.gain.delta_bic)


def left_to(trial: FittedCandidate, system: System) -> float:
    """Evidence of a candidate, with the values it was found at, beside the system's causes."""
    gain = beside(trial, system)
    return -np.inf if gain is None else gain.delta_bic


def at_one_joint(
    pair: tuple[FittedCandidate, Judgement], others: Sequence[tuple[FittedCandidate, Judgement]]
) -> bool:
    """Whether what was tried for all joints together promises at none what it does alone at one of them."""
    trial, by = pair
    return trial.candidate.joint is None and any(
        t.candidate.effect == trial.candidate.effect and by.expected < ALIKE * other.expected
        for t, other in others
        if t.candidate.joint is not None
    )


def imitated(
    pair: tuple[FittedCandidate, Judgement], others: Sequence[tuple[FittedCandidate, Judgement]]
) -> bool:
    """Whether it looks like what shows elsewhere, as the least power of the speed does like dry friction that
    is lower near rest, and a law of that is there at its joint.
    """
    c = pair[0].candidate
    where = c.definition.imitates(pair[0].values)
    return where is not None and any(
        where in t.candidate.definition.shows and t.candidate.joint == c.joint for t, _ in others
    )


def _given_way(
    pair: tuple[FittedCandidate, Judgement], passed: Sequence[tuple[FittedCandidate, Judgement]]
) -> str:
    """Why what passed every gate is not what is there; empty for most."""
    if at_one_joint(pair, passed):
        return "one joint"
    return "near rest" if imitated(pair, passed) else ""


def correlated(system: System) -> bool:
    """Whether errors of the positions matter: the regressor's correlation with those of the equations."""
    found = endogeneity(system)
    return found is not None and found.found and float(found.share.max()) > PRACTICAL


def _harmless(rows: Sequence[Rows], blur: Array | None, system: System) -> bool:
    """Whether errors of the positions need no other price than `blur`."""
    return blur is not None and harmless(rows, blur, mean_squares(system), PRACTICAL)


def _margin(best: FittedCandidate, gain: float, system: System, blur: Array | None) -> float:
    """Percent of what a rival leaves by which errors of coarse positions can put the best before it."""
    if blur is None:
        return -np.inf
    left = mean_squares(system) * (1.0 - gain / 100.0) ** 2
    found = float(feigned(blur, left)[best.candidate.joints(system.n)].max())
    return found if found > PRACTICAL else -np.inf
