"""Causes that a shape outdoes: they stand for something that the catalogue does not have."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from modelgen.diagnosis.adequacy.lack_of_fit import Test, in_parts, lack_of_fit, repeating
from modelgen.diagnosis.adequacy.null_distribution import NULLS
from modelgen.diagnosis.adequacy.smooth_functions import SHAPE, SmoothFunction, Worth, log_evidence
from modelgen.diagnosis.equations.rows import Rows
from modelgen.diagnosis.evidence.system import System, mean_squares
from modelgen.diagnosis.selection.cause import Cause, Selection, together
from modelgen.diagnosis.selection.history import STANDS_IN
from modelgen.diagnosis.thresholds import CLEAN, PRACTICAL
from modelgen.diagnosis.validation.form_error import with_causes
from modelgen.effects import Shows
from modelgen.numeric import Array

BESIDE = 7.0  # delta BIC beside a cause, from which a shape may take its place
LIKE = float(np.quantile(NULLS[SHAPE], CLEAN))  # delta BIC from which what is left is called like a shape
TWICE = 2.0  # a cause's evidence: what has that beside it makes it a detail
CLEARLY = 7.0  # delta BIC by which a shape is more than a cause that stands alone, with half of BESIDE
# Delta BIC in the plain equations, of a shape beside a cause and over it, if it is as good else: in complete
# models shapes have 37 there once in 200.
SLOW = 40.0
# Delta BIC less than the cause's, and more by so much of it, in the fair equations.
AS_GOOD, OF_IT = 5.0, 0.01
BEHIND = 20.0  # delta BIC less than the cause's, in the plain ones, from which no shape takes its place
SEARCHED = 8.0  # delta BIC that each further cause costs, as one of some sixty at every joint: 2 ln 60
LEAST = 2 / 3  # of what repeats, explained
MOST = 1 / 2  # of what repeats in the part of the period that shows most, left
PLAIN = 250.0  # delta BIC; play gave 500 to 2800
PLAINLY = 1.5  # times the threshold in a part, where a cause falls by what is left elsewhere
MUCH = 0.1  # of the residuals' power that repeats: below, the joint is explained


@dataclass(frozen=True)
class Likeness:
    """What the causes leave is most like `shape`, with this evidence (delta BIC)."""

    shape: SmoothFunction
    evidence: float


def without_stand_ins(
    selection: Selection, rows: Sequence[Rows], found: Sequence[SmoothFunction]
) -> tuple[Selection, list[Cause], Likeness | None]:
    """The selection without the causes that a shape outdoes, those causes, and what is left is most like.

    A shape outdoes a cause where it explains more of what the other causes leave, and something beside the
    cause, or the cause leaves most of what repeats; where it explains more beside it than twice what the
    cause does; and the least of several causes where it alone explains more than they do together. Of what
    an effect that is there does, a shape explains less, for the price of its freedom. All evidence is that
    of the noise which all causes leave: what they explain is none.
    found: empty for free motions, which show little but forces that depend on where the arm is; there all
    causes go that leave most of what repeats.
    """
    dropped: list[Cause] = []
    while True:
        system, causes = selection.system, selection.causes
        beside = [(shape, log_evidence(shape, system)) for shape in found]
        doubted = doubtful(selection, rows)
        every = len(causes) > 1 and bool(found) and _outdone_together(causes, rows, system, found)
        lost = [
            c
            for c in causes
            if every
            or (not found and c in doubted)
            or _outdone(c, causes, rows, system, beside, c in doubted)
        ]
        if not lost:
            left = [Likeness(s, w.evidence) for s, w in beside if w.evidence > LIKE and w.percent > PRACTICAL]
            return selection, dropped, max(left, key=lambda likeness: likeness.evidence, default=None)
        worst = min(lost, key=lambda c: c.delta_bic)
        dropped.append(worst)
        selection = selection.without([worst], STANDS_IN)


def _outdone(
    cause: Cause,
    causes: Sequence[Cause],
    rows: Sequence[Rows],
    system: System,
    beside: Sequence[tuple[SmoothFunction, Worth]],
    doubted: bool,
) -> bool:
    """Whether one of the shapes, with what they are worth beside all causes, takes the cause's place."""
    least = BESIDE / 2 if len(causes) == 1 else BESIDE
    able = [(s, w) for s, w in beside if doubted or w.evidence > least or w.slow > SLOW]
    if not able:
        return False
    others = [c.trial for c in causes if c is not cause]
    without = System(rows, with_causes(rows, others), system.periods, system)
    own = together([cause.trial], without, fair=True)
    most = max(w.evidence for _, w in able)
    if most > BESIDE and TWICE * own < most:
        return True
    rough = max(cause.delta_bic, together([cause.trial], without, alike=True) - cause.trial.prior_penalty)
    for shape, added in able:
        instead = log_evidence(shape, without)
        more, slow = instead.evidence - own, instead.slow - rough
        seen = doubted or added.evidence > BESIDE or (added.evidence > least and more > CLEARLY)
        if more > 0.0 and seen and slow > -BEHIND:
            return True
        if more > -AS_GOOD - OF_IT * max(own, 0.0) and min(slow, added.slow) > SLOW:
            return True
    return False


def _outdone_together(
    causes: Sequence[Cause], rows: Sequence[Rows], system: System, found: Sequence[SmoothFunction]
) -> bool:
    """Whether one shape explains more than several causes together, or than some of them."""
    bare = System(rows, with_causes(rows, []), system.periods, system)
    trials = [c.trial for c in causes]
    explained = max(
        together(some, bare, fair=True) - SEARCHED * (len(some) - 1)
        for count in range(1, len(trials) + 1)
        for some in combinations(trials, count)
    )
    alone = max(log_evidence(shape, bare).evidence for shape in found)
    return bool(np.isfinite(explained)) and alone > explained


def doubtful(selection: Selection, rows: Sequence[Rows]) -> list[Cause]:
    """The causes that leave most of what repeats."""
    system = selection.system
    if not selection.causes:
        return []
    old = System(rows, [r.columns for r in rows], system.periods)
    fit = lack_of_fit(old)
    if fit is None or not fit.found:
        return []
    sizes = mean_squares(old)
    first, last = repeating(old) / sizes, repeating(system) / sizes
    much = repeating(system) > MUCH * mean_squares(system)
    parts = in_parts(system)
    worst, left = (_worst(tests, system.n) / sizes for tests in (in_parts(old), parts))
    found = any(t.found for t in parts)
    clearly = any(t.statistic > PLAINLY * t.threshold for t in parts)
    doubted = []
    for cause in selection.causes:
        rough = Shows.IMPACTS in cause.trial.candidate.definition.shows
        if rough and cause.delta_bic > PLAIN:
            continue
        joints = cause.trial.candidate.joints(system.n)
        little = much[joints].any() and last[joints].sum() > (1 - LEAST) * first[joints].sum()
        shown = worst[joints].max()
        missed = (found and left[joints].max() > MOST * shown) or (clearly and left.max() > shown)
        if little or missed:
            doubted.append(cause)
    return doubted


def _worst(tests: Sequence[Test], n: int) -> Array:
    """What repeats in the part of the period that shows most, by joint (n,) [effort^2]."""
    found = np.zeros(n)
    for t in tests:
        found[t.joint] = max(found[t.joint], t.excess)
    return found
