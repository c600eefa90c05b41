"""Causes that a shape outdoes: they stand for something that the catalogue does not have."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from modelgen.diagnosis.adequacy.lack_of_fit import Test, in_parts, lack_of_fit, repeating
from modelgen.diagnosis.adequacy.null_distribution import NULLS
from modelgen.diagnosis.adequacy.smooth_functions import SHAPE, SmoothFunction, Worth, log_evidence
from modelgen.diagnosis.candidates import system_of
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.evidence import System, mean_squares
from modelgen.diagnosis.options.thresholds import AdequacyThresholds
from modelgen.diagnosis.selection import STANDS_IN, Cause, Selection, together
from modelgen.effects import Shows
from modelgen.numeric import Array


@dataclass(frozen=True)
class Likeness:
    """A shape that what the causes leave is most like, with its evidence (delta BIC)."""

    shape: SmoothFunction
    evidence: float


def without_stand_ins(
    selection: Selection, equations: Equations, found: Sequence[SmoothFunction]
) -> tuple[Selection, list[Cause], Likeness | None]:
    """The selection without the causes that a shape outdoes, those causes, and what is left is most like.

    A shape outdoes a cause where it explains more of what the other causes leave, and something beside the
    cause, or the cause leaves most of what repeats; where it explains more beside it than twice what the
    cause does; and the least of several causes where it alone explains more than they do together. Of what an
    effect that is there does, a shape explains less, for the price of its freedom. All evidence is that of
    the noise which all causes leave: what they explain is none. equations: of the band, all rows that move.
    found: empty for free motions, which show little but forces that depend on where the arm is; there all
    causes go that leave most of what repeats.
    """
    limits = equations.thresholds
    like, worth = like_delta_bic(limits.adequacy), limits.validation.min_gain_percent
    dropped: list[Cause] = []
    while True:
        system, causes = selection.system, selection.causes
        beside = [(shape, log_evidence(shape, system)) for shape in found]
        doubted = doubtful(selection, equations)
        every = len(causes) > 1 and bool(found) and _outdone_together(selection, equations, found)
        lost = [
            c
            for c in causes
            if every
            or (not found and c in doubted)
            or _outdone(c, selection, equations, beside, c in doubted)
        ]
        if not lost:
            left = [Likeness(s, w.evidence) for s, w in beside if w.evidence > like and w.percent > worth]
            return selection, dropped, max(left, key=lambda likeness: likeness.evidence, default=None)
        worst = min(lost, key=lambda c: c.delta_bic)
        dropped.append(worst)
        selection = selection.without([worst], STANDS_IN)


def _outdone(
    cause: Cause,
    selection: Selection,
    equations: Equations,
    beside: Sequence[tuple[SmoothFunction, Worth]],
    doubted: bool,
) -> bool:
    """Whether one of the shapes, with what they are worth beside all causes, takes the cause's place."""
    causes, limits = selection.causes, equations.thresholds.adequacy
    seen_from, slow_from = limits.beside_delta_bic, limits.slow_delta_bic
    least = seen_from / 2 if len(causes) == 1 else seen_from
    able = [(s, w) for s, w in beside if doubted or w.evidence > least or w.slow > slow_from]
    if not able:
        return False
    others = [c.trial for c in causes if c is not cause]
    without = system_of(equations, others, selection.system)
    own = together([cause.trial], without, fair=True)
    most = max(w.evidence for _, w in able)
    if most > seen_from and limits.detail_ratio * own < most:
        return True
    rough = max(cause.delta_bic, together([cause.trial], without, alike=True) - cause.trial.prior_penalty)
    for shape, added in able:
        instead = log_evidence(shape, without)
        more, slow = instead.evidence - own, instead.slow - rough
        clearly = added.evidence > least and more > limits.lone_cause_delta_bic
        seen = doubted or added.evidence > seen_from or clearly
        if more > 0.0 and seen and slow > -limits.behind_delta_bic:
            return True
        behind = -limits.as_good_delta_bic - limits.as_good_share * max(own, 0.0)
        if more > behind and min(slow, added.slow) > slow_from:
            return True
    return False


def _outdone_together(selection: Selection, equations: Equations, found: Sequence[SmoothFunction]) -> bool:
    """Whether one shape explains more than several causes together, or than some of them."""
    bare = System(equations, noise=selection.system)
    price = equations.thresholds.adequacy.further_cause_price
    trials = [c.trial for c in selection.causes]
    explained = max(
        together(some, bare, fair=True) - price * (len(some) - 1)
        for count in range(1, len(trials) + 1)
        for some in combinations(trials, count)
    )
    alone = max(log_evidence(shape, bare).evidence for shape in found)
    return bool(np.isfinite(explained)) and alone > explained


def like_delta_bic(limits: AdequacyThresholds) -> float:
    """Evidence from which what is left is called like a function of no law."""
    return float(np.quantile(NULLS[SHAPE], limits.null_share))


def doubtful(selection: Selection, equations: Equations) -> list[Cause]:
    """The causes that leave most of what repeats."""
    system, limits = selection.system, equations.thresholds.adequacy
    if not selection.causes:
        return []
    old = System(equations)
    fit = lack_of_fit(old)
    if fit is None or not fit.found:
        return []
    sizes = mean_squares(old)
    first, last = repeating(old) / sizes, repeating(system) / sizes
    much = repeating(system) > limits.min_repeating_share * mean_squares(system)
    parts = in_parts(system)
    worst, left = (_worst(tests, system.n) / sizes for tests in (in_parts(old), parts))
    found = any(t.found for t in parts)
    clearly = any(t.statistic > limits.clear_part_ratio * t.threshold for t in parts)
    doubted = []
    for cause in selection.causes:
        rough = Shows.IMPACTS in cause.trial.candidate.definition.shows
        if rough and cause.delta_bic > limits.rough_delta_bic:
            continue
        joints = cause.trial.candidate.joints(system.n)
        little = (
            much[joints].any()
            and last[joints].sum() > (1 - limits.min_explained_repeating) * first[joints].sum()
        )
        shown = worst[joints].max()
        missed = (found and left[joints].max() > limits.max_left_in_part * shown) or (
            clearly and left.max() > shown
        )
        if little or missed:
            doubted.append(cause)
    return doubted


def _worst(tests: Sequence[Test], n: int) -> Array:
    """Sum that repeats in the part of the period that shows most, by joint (n,) [effort^2]."""
    found = np.zeros(n)
    for t in tests:
        found[t.joint] = max(found[t.joint], t.excess)
    return found
