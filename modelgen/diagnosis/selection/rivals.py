"""Candidates that could stand for a cause: its ambiguity set."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modelgen.diagnosis.candidates import FittedCandidate, beside
from modelgen.diagnosis.equations import feigned
from modelgen.diagnosis.evidence import System, mean_squares
from modelgen.diagnosis.options.thresholds import SelectionThresholds
from modelgen.diagnosis.selection.cause import Cause
from modelgen.diagnosis.selection.compliance import Judged, alternatives
from modelgen.diagnosis.selection.marginality import varied
from modelgen.diagnosis.validation import Conditions

Rival = tuple[FittedCandidate, float]  # and by how much delta BIC it is behind


def rivals_of(chosen: Judged, eligible: Sequence[Judged], system: System) -> list[Rival]:
    """Candidates that passed as well and are behind by little: in evidence, or in what they gain by less than
    errors of coarse positions could feign. What lets the chosen one vary is asked for beside it, in the next
    turn, and no rival. system: without the chosen one.
    """
    best, by = chosen
    limits = system.equations.thresholds.selection
    margin = _margin(best, by.gain, system)
    found = []
    for t, other in eligible:
        behind = best.gain.delta_bic - t.gain.delta_bic
        less = 100.0 * (by.gain - other.gain) / (100.0 - other.gain)
        near = behind <= needed_behind(best, t, limits) or less <= margin
        if t.candidate != best.candidate and near and not varied(t.candidate, best.candidate):
            found.append((t, max(0.0, behind)))
    return found


def lesser_rivals(
    best: FittedCandidate, faint: Sequence[FittedCandidate], conditions: Conditions
) -> list[Rival]:
    """Rivals of the best that cannot be named themselves and may be what is there all the same: of too little
    evidence, where the best has little more.
    """
    most = conditions.equations.thresholds.selection.rival_margin_bic
    behind = [(t, best.gain.delta_bic - t.gain.delta_bic) for t in faint]
    others = [(t, by) for t, by in behind if by <= most and t.candidate != best.candidate]
    near = [(t, max(0.0, by)) for t, by in others if not varied(t.candidate, best.candidate)]
    return [(t, by) for t, by in near if not conditions.judged(t).refused]


def ambiguity_set(causes: Sequence[Cause], system: System) -> list[Cause]:
    """The causes, each with those rivals that could stand for it in the end: what is named as well, or keeps
    its evidence beside the causes, could not.
    """
    share = system.equations.thresholds.selection.max_rival_share
    named, found = {c.trial.candidate.place for c in causes}, []
    for cause in causes:
        others = {t.candidate.place: (t, by) for t, by in reversed([*cause.rivals, *cause.lesser])}
        rivals = [r for place, r in reversed(others.items()) if place not in named]
        kept = [(t, behind) for t, behind in rivals if left_to(t, system) < share * t.gain.delta_bic]
        found.append(replace(cause, rivals=kept))
    return found


def needed_behind(best: FittedCandidate, other: FittedCandidate, limits: SelectionThresholds) -> float:
    """Delta BIC by which a rival must be behind to be none."""
    share = limits.rival_margin_of_evidence if alternatives(best.candidate, other.candidate) else 0.0
    return max(limits.rival_margin_bic, share * best.gain.delta_bic)


def left_to(trial: FittedCandidate, system: System) -> float:
    """Evidence of a candidate, with the values it was found at, beside the system's causes."""
    gain = beside(trial, system)
    return -np.inf if gain is None else gain.delta_bic


def given_way(pair: Judged, passed: Sequence[Judged], share: float) -> str:
    """Why what passed validation is not what is there; empty for most. share: as of `at_one_joint`."""
    if at_one_joint(pair, passed, share):
        return "one joint"
    return "near rest" if imitated(pair, passed) else ""


def at_one_joint(pair: Judged, others: Sequence[Judged], share: float) -> bool:
    """Whether what was tried for all joints together promises less than a share of what it does alone at one
    of them: what is in all drives alike promises as much there.
    """
    trial, by = pair
    return trial.candidate.joint is None and any(
        t.candidate.effect == trial.candidate.effect and by.expected < share * other.expected
        for t, other in others
        if t.candidate.joint is not None
    )


def imitated(pair: Judged, others: Sequence[Judged]) -> bool:
    """Whether it looks like what shows elsewhere, as the least power of the speed does like dry friction that
    is lower near rest, and a law of that is there at its joint.
    """
    c = pair[0].candidate
    where = c.definition.imitates(pair[0].values)
    return where is not None and any(
        where in t.candidate.definition.shows and t.candidate.joint == c.joint for t, _ in others
    )


def _margin(best: FittedCandidate, gain: float, system: System) -> float:
    """Percent of what a rival leaves by which errors of coarse positions can put the best before it."""
    equations = system.equations
    left = mean_squares(system) * (1.0 - gain / 100.0) ** 2
    found = float(feigned(equations.blur, left)[best.candidate.joints(system.n)].max())
    return found if found > equations.thresholds.validation.min_gain_percent else -np.inf
