"""Two causes of a joint at once, where one after the other goes astray.

Friction in proportion to the load is nothing, or has the wrong sign, where part of what the links are
thought to weigh is a spring's; and the spring is nothing while the load has it. Steps that see one candidate
at a time pass both by (Miller 2002, 3.9). Where the causes of a joint fail their checks, pairs of what
follows the load with one other are tried in their place, with the load's own change with the parameters.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from modelgen.diagnosis.candidates import (
    Candidate,
    FittedCandidate,
    Search,
    fit_pool,
    sensible,
    system_of,
    with_causes,
)
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.evidence import System
from modelgen.diagnosis.selection.backward import measured
from modelgen.diagnosis.selection.cause import Cause, Selection
from modelgen.diagnosis.selection.exchange import worth_of
from modelgen.diagnosis.selection.history import best_of_each, ranked
from modelgen.diagnosis.selection.refit import refit
from modelgen.diagnosis.selection.refit_by_load import follows_load, linearised, loaded
from modelgen.diagnosis.selection.rivals import needed_behind
from modelgen.jobs import Where
from modelgen.regression.weighted import misfit, weighted_fit

REFITTED = 3  # pairs of each, those that a first step says to explain most: a budget


def doubtful_joints(
    causes: Sequence[Cause], suspects: Sequence[Cause], pool: Sequence[Candidate], equations: Equations
) -> list[int]:
    """Joints (from 1) at which a pair may be there instead of the causes: where one of them is a suspect, or
    people confuse it with what follows the load and is none of them.
    """
    loads = {c.place for c in pool if follows_load(c, equations)}
    named = {c.trial.candidate.place for c in causes}
    found = {c.trial.candidate.joint for c in suspects}
    for cause in causes:
        c = cause.trial.candidate
        others = ((name, c.joint) for name in c.definition.confused_with)
        if any(place in loads and place not in named for place in others):
            found.add(c.joint)
    return sorted(j for j in found if j is not None and any(joint == j for _, joint in loads))


def paired(
    causes: Sequence[Cause], joint: int, pool: Sequence[Candidate], equations: Equations, where: Where
) -> tuple[float, list[Cause]] | None:
    """The causes with the pair that explains most in the place of those at a joint (from 1), and by how much
    evidence that is ahead of these; None where there is none. Further pairs are rivals of its second.
    """
    kept = [c for c in causes if c.trial.candidate.joint != joint]
    taken = {c.trial.candidate.place for c in kept}
    own = [c for c in pool if c.joint == joint and not c.elastic and c.place not in taken]
    rest = system_of(equations, [c.trial for c in kept])
    trials = [t for t in fit_pool(own, Search(rest), where) if t is not None]
    bare, found = System(equations), list[tuple[float, list[Cause]]]()
    for first in trials:
        if loaded(first, equations):
            for second in _likely(first, trials, kept, equations):
                found += _refitted(first, second, kept, equations, bare)
    if not found:
        return None
    found.sort(key=lambda pair: -pair[0])
    most, best = found[0]
    second, limits = best[-1].trial, equations.thresholds.selection
    others = [(tried[-1].trial, most - worth) for worth, tried in found[1:]]
    rivals = [
        (t, behind)
        for t, behind in others
        if t.candidate.place != second.candidate.place and behind <= needed_behind(second, t, limits)
    ]
    return most - worth_of(causes, bare), [*best[:-1], replace(best[-1], rivals=rivals)]


def with_rival(selection: Selection, pair: Sequence[Cause], ahead: float) -> Selection:
    """The selection where what follows the load, the first of a pair, is a rival of the cause that people
    confuse it with. ahead: of the pair, in evidence.
    """
    first = pair[0].trial
    causes = [
        replace(c, rivals=[*c.rivals, (first, max(0.0, -ahead))])
        if first.candidate.effect in c.trial.candidate.definition.confused_with
        and c.trial.candidate.joint == first.candidate.joint
        else c
        for c in selection.causes
    ]
    return replace(selection, causes=causes)


def with_pair(
    selection: Selection, found: Sequence[Cause], suspects: Sequence[Cause], equations: Equations
) -> Selection:
    """The selection to go on from with the causes as `paired` has them, but for suspects: these were found
    beside others than they are beside now, and are asked for anew. The pair has a turn each.
    """
    doubtful = {c.trial.candidate.place for c in suspects}
    kept = [c for c in found[:-2] if c.trial.candidate.place not in doubtful]
    every = [*kept, *found[-2:]]
    system = system_of(equations, [c.trial for c in every])
    causes = [measured(c, every, system) for c in every]
    places = {c.trial.candidate.place for c in kept}
    turns = [turn for turn in selection.turns if any(r.chosen and r.place in places for r in turn)]
    for c in causes[-2:]:
        own = replace(c.trial, gain=replace(c.trial.gain, delta_bic=c.delta_bic))
        ranking = [ranked(t, None, "") for t in (own, *(t for t, _ in c.rivals))]
        turns.append(best_of_each(ranking, own.candidate.place))
    return Selection(causes, system, turns)


def _likely(
    first: FittedCandidate, trials: Sequence[FittedCandidate], kept: Sequence[Cause], equations: Equations
) -> list[FittedCandidate]:
    """The others that explain most beside the first, by one step of Gauss's and Newton's."""
    beside = [*(c.trial for c in kept), first]
    table = with_causes(equations, beside)
    theta = weighted_fit(equations.rows, table)
    moved, slopes = linearised([first], beside, table, theta, equations)
    left = list[tuple[float, int, FittedCandidate]]()
    for t in trials:
        if t.candidate.place == first.candidate.place:
            continue
        whole = [np.concatenate([s, c], axis=2) for s, c in zip(slopes, t.columns, strict=True)]
        left.append((misfit(moved, whole, weighted_fit(moved, whole)), len(left), t))
    return [t for _, _, t in sorted(left, key=lambda pair: pair[:2])[:REFITTED]]


def _refitted(
    first: FittedCandidate,
    second: FittedCandidate,
    kept: Sequence[Cause],
    equations: Equations,
    bare: System,
) -> Iterator[tuple[float, list[Cause]]]:
    """A pair beside the causes that are kept, all found anew, and what all are worth; nothing where the arm
    does not admit its values.
    """
    pair = [Cause(t, np.nan, np.nan, np.nan) for t in (first, second)]
    tried = [*(replace(c) for c in kept), *pair]
    refit(tried, equations)
    if all(sensible(c.trial, equations) for c in pair):
        yield worth_of(tried, bare), tried
