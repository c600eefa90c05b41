"""Forward selection of causes, exchange and backward elimination; each must pass validation."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

from modelgen.diagnosis.candidates import (
    Candidate,
    Columns,
    FittedCandidate,
    Search,
    fit_pool,
    sensible,
    system_of,
    without_rests,
)
from modelgen.diagnosis.equations import Equations, harmless, repeating_errors
from modelgen.diagnosis.evidence import System, endogeneity, mean_squares
from modelgen.diagnosis.selection.backward import backward_elimination, measured
from modelgen.diagnosis.selection.cause import Cause, Selection
from modelgen.diagnosis.selection.compliance import Judged, member, refine, refined
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
from modelgen.diagnosis.selection.marginality import constant_first
from modelgen.diagnosis.selection.refit import refit
from modelgen.diagnosis.selection.rivals import ambiguity_set, given_way, lesser_rivals, rivals_of
from modelgen.diagnosis.validation import Conditions, instrumented
from modelgen.jobs import HERE, Where

Report = Callable[[str, int, int], None]


def forward_selection(
    equations: Equations,
    pool: Sequence[Candidate],
    report: Report | None = None,
    where: Where = HERE,
    start: Selection | None = None,
) -> Selection:
    """Causes in the order in which they were found. where: processes among which candidates are shared.
    start: to go on from, where something was found before.

    One cause after the other is chosen; then each gives its place to the rival with which all have more
    evidence; then those leave that the others have made superfluous.
    """
    steps = _Steps(equations, pool, report, where, start)
    limits = equations.thresholds.selection
    most = max(limits.max_causes, limits.max_causes_per_joint * equations.n)
    for _ in range(most - len(steps.causes)):
        if not steps.take():
            break
    steps.exchange()
    steps.eliminate()
    return Selection(ambiguity_set(steps.causes, steps.system), steps.system, steps.turns)


class _Steps:
    """A selection on its way: the causes so far, the system with them, and what was asked at every step."""

    def __init__(
        self,
        equations: Equations,
        pool: Sequence[Candidate],
        report: Report | None,
        where: Where,
        start: Selection | None,
    ) -> None:
        self.pool, self.report, self.where = pool, report, where
        self.causes: list[Cause] = [] if start is None else list(start.causes)
        self.system = System(equations) if start is None else start.system
        self.evidence = threshold(self.system)
        self.known: Columns = {}
        self.turns: History = [] if start is None else list(start.turns)
        # errors of a known size: what they could feign is their price
        self.stepped = bool(repeating_errors(equations).any())

    @property
    def equations(self) -> Equations:
        """Equations as the causes have left them: one that rests takes its rows with it."""
        return self.system.equations

    @property
    def trials(self) -> list[FittedCandidate]:
        """The causes, as they were fitted."""
        return [c.trial for c in self.causes]

    def take(self) -> bool:
        """Take the best candidate that passes every gate; False where none does."""
        trials, faint, astray, ranking = self._fitted()
        settled = refined(trials, astray, self.causes, self.system, self.where)
        conditions = Conditions(self.system, self.trials)
        judged = self._judged(sorted([*trials, *settled], key=lambda t: -t.odds), conditions)
        ranking += [ranked(t, by, by.refused) for t, by in judged]
        eligible = [pair for pair in judged if not pair[1].refused]
        if not eligible:
            self.turns.append(best_of_each(ranking, None))
            return False
        best, by = constant_first(member(eligible[0], eligible, self.equations.thresholds), eligible)
        self.turns.append(best_of_each(ranking, best.candidate.place))
        rivals, lesser = rivals_of((best, by), eligible, self.system), lesser_rivals(best, faint, conditions)
        own = [t for t in settled if t.candidate == best.candidate]
        self.causes.append(
            Cause((own or [best])[0], best.gain.delta_bic, by.gain, by.expected, rivals, lesser)
        )
        equations = without_rests(self.equations, best.candidate, best.parameters)
        refit(self.causes, equations)
        if not own:
            refine(self.causes, equations)
        self.system = system_of(equations, self.trials)
        return True

    def _fitted(
        self,
    ) -> tuple[list[FittedCandidate], list[FittedCandidate], list[FittedCandidate], list[Ranked]]:
        """Candidates with evidence, those with too little of it, elastic ones with senseless values, and what
        evidence or values refuse.
        """
        elastic = {t.candidate.joint for t in self.trials if t.candidate.elastic}
        search = Search(self.system, self.known, elastic)
        taken = {t.candidate.place for t in self.trials}
        left = [c for c in self.pool if c.place not in taken and not self._last(c)]
        stage = f"candidates for cause {len(self.causes) + 1}"
        told = None if self.report is None else partial(self.report, stage)
        trials, faint, astray, refused = [], [], [], []
        for found in fit_pool(left, search, self.where, told):
            if found is None:
                continue
            if found.gain.delta_bic < max(least_evidence(found, self.equations), self.evidence):
                refused.append(ranked(found, None, "evidence"))
                if found.gain.delta_bic > 0 and sensible(found, self.equations):
                    faint.append(found)
            elif not sensible(found, self.equations):
                refused.append(ranked(found, None, "values"))
                astray += [found] if found.candidate.elastic else []
            else:
                trials.append(found)
        return trials, faint, astray, refused

    def _last(self, c: Candidate) -> bool:
        """Whether an effect that shows between joints alone is a cause at all the others already: at all of
        them it is the scale of the parameters, and a fit that shrinks everything has the least residuals.
        """
        arm = self.equations.arm
        if not c.definition.relative or c.joint is None:
            return False
        others = {j for j in range(1, self.equations.n + 1) if c.definition.stands_at(arm, j)} - {c.joint}
        return bool(others) and others <= {
            t.candidate.joint for t in self.trials if t.candidate.effect == c.effect
        }

    def _judged(self, trials: Sequence[FittedCandidate], conditions: Conditions) -> list[Judged]:
        """Judge the trials by the conditions; some of those that pass give way to others."""
        priced = self.stepped or harmless(self.equations, mean_squares(self.system))
        noisy = not priced and correlated(self.system)
        found: list[Judged] = []
        for t in trials:
            by = conditions.judged(t)
            # behind an elastic joint a link swings otherwise in every period, as errors do
            if (
                noisy
                and not by.refused
                and not instrumented(t, self.system)
                and (not t.candidate.elastic or correlated(system_of(self.equations, [*self.trials, t])))
            ):
                by = replace(by, refused="positions")
            found.append((t, by))
        passed = [pair for pair in found if not pair[1].refused]
        share = self.equations.thresholds.selection.min_whole_arm_share
        return [
            (t, by if by.refused else replace(by, refused=given_way((t, by), passed, share)))
            for t, by in found
        ]

    def exchange(self) -> None:
        """Give the place of causes to rivals with which all have more evidence."""
        better = exchanged(self.causes, self.equations)
        if better is None:
            return
        for old, new in zip(self.causes, better, strict=True):
            place, before = new.trial.candidate.place, old.trial.candidate.place
            if place != before:
                self.turns = taken_back(self.turns, before, EXCHANGED, place)
        self.system = system_of(self.equations, [c.trial for c in better])
        self.causes = [
            new if new.trial.candidate == old.trial.candidate else measured(new, better, self.system)
            for new, old in zip(better, self.causes, strict=True)
        ]

    def eliminate(self) -> None:
        """Leave out what the other causes have made superfluous."""
        every = self.causes[:]
        self.causes, self.system = backward_elimination(self.causes, self.system, self.evidence)
        lost = [c for c in every if all(c is not kept for kept in self.causes)]
        if not lost:
            return
        for cause in lost:
            self.turns = taken_back(self.turns, cause.trial.candidate.place, SUPERFLUOUS)
        refit(self.causes, self.equations)
        self.system = system_of(self.equations, self.trials)


def least_evidence(trial: FittedCandidate, equations: Equations) -> float:
    """Delta BIC that it takes to name this cause where the noise is known."""
    limits = equations.thresholds.selection
    if trial.gain.rank + len(trial.candidate.searched) == 1:
        return limits.single_parameter_delta_bic
    return limits.fading_delta_bic if trial.candidate.passing else limits.min_delta_bic


def needed_evidence(trial: FittedCandidate, system: System) -> float:
    """Delta BIC that it takes to name this cause in this system's noise."""
    return max(least_evidence(trial, system.equations), threshold(system))


def threshold(system: System) -> float:
    """Delta BIC that it takes to name a cause."""
    limits = system.equations.thresholds.selection
    return limits.min_delta_bic if system.coloured else limits.unknown_noise_delta_bic


def correlated(system: System) -> bool:
    """Whether errors of the positions matter: the regressor's correlation with those of the equations."""
    found = endogeneity(system)
    least = system.equations.thresholds.validation.min_gain_percent
    return found is not None and found.found and float(found.share.max()) > least
