"""Whether another candidate, refused or not, explains more than a cause: the runner-up is not the name."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from modelgen.diagnosis.candidates import Candidate, Place
from modelgen.diagnosis.selection import EXCHANGED, SUPERFLUOUS, Cause, Ranked, Selection, lets_vary
from modelgen.effects import CATALOGUE, Family

# Refusals for want of evidence, of values that can be, or of a form of itself: they leave a cause its name.
_LESSER = ("", "evidence", "values", "near rest", "one joint", EXCHANGED, SUPERFLUOUS)


@dataclass(frozen=True)
class Dominance:
    """ahead: delta BIC by which the candidate `place` is ahead of a cause, the most of all; most: by which
    it may be.
    """

    ahead: float
    most: float
    place: Place | None = None


def dominance(cause: Cause, selection: Selection) -> Dominance:
    """The candidate that is ahead of the cause by most, of those that validation refused.

    At the cause's turn, or beside all causes in the end: at its joint or of the whole arm. A constant law
    that the cause lets vary may not be ahead at all: what explains as much without varying shows no
    variation. None of a free motion.
    """
    equations = selection.system.equations
    most = equations.thresholds.adequacy.max_behind_refused
    if equations.free or not selection.turns:
        return Dominance(-np.inf, most)
    c = cause.trial.candidate
    named = {other.trial.candidate.place for other in selection.causes}
    found = [Dominance(-np.inf, most)]
    for turn in selection.turns:
        own = next((r for r in turn if r.chosen and r.place == c.place), None)
        if own is not None:
            there = [r for r in turn if _dominates(r, c, named) or _swings(r, c)]
            found += [_over(r, own.delta_bic, c, most) for r in there]
    if not any(r.chosen for r in selection.turns[-1]):
        last = [r for r in selection.turns[-1] if _dominates(r, c, named)]
        found += [_over(r, cause.delta_bic, c, most) for r in last]
    return max(found, key=lambda d: d.ahead - d.most)


def _over(r: Ranked, evidence: float, c: Candidate, most: float) -> Dominance:
    constant = r.joint == c.joint and CATALOGUE[r.effect] in c.definition.varies
    return Dominance(r.delta_bic - evidence, 0.0 if constant else most, r.place)


def _dominates(r: Ranked, c: Candidate, named: Collection[Place]) -> bool:
    """Whether what was refused, then and for good, could be there instead of the candidate."""
    if r.refused in _LESSER or r.place in named or lets_vary(r.effect, r.joint, c):
        return False
    return r.joint is None or r.joint == c.joint


def _swings(r: Ranked, c: Candidate) -> bool:
    """Whether a joint bends or has play by values that no arm has, where the candidate does not: what such a
    law explains comes late or swings, and has the form of neither.
    """
    elastic = CATALOGUE[r.effect].family is Family.ELASTIC
    return r.refused == "values" and elastic and not c.elastic and r.joint == c.joint
