"""Causes that a shape outdoes: they stand for something that the catalogue does not have."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from modelgen.diagnosis.causes import Cause, together
from modelgen.diagnosis.gates import PRACTICAL, with_causes
from modelgen.diagnosis.lack_of_fit import CLEAN
from modelgen.diagnosis.null_distribution import NULLS
from modelgen.diagnosis.rows import Rows
from modelgen.diagnosis.selection import Selection
from modelgen.diagnosis.shapes import SHAPE, Shape, worth
from modelgen.diagnosis.standing import doubtful
from modelgen.diagnosis.system import System

BESIDE = 20.0  # delta BIC beside a cause, from which a shape may take its place
LIKE = float(np.quantile(NULLS[SHAPE], CLEAN))  # delta BIC from which what is left is called like a shape
TWICE = 2.0  # a cause's evidence: what has that beside it makes it a detail
CLEARLY = 14.0  # delta BIC by which a shape is more than a cause that stands alone, with half of BESIDE
SEARCHED = 8.0  # delta BIC that each further cause costs, as one of some sixty at every joint: 2 ln 60


@dataclass(frozen=True)
class Likeness:
    """What the causes leave is most like `shape`, with this evidence (delta BIC)."""

    shape: Shape
    evidence: float


def outdone(
    selection: Selection, rows: Sequence[Rows], found: Sequence[Shape]
) -> tuple[Selection, list[Cause], Likeness | None]:
    """The selection without the causes that a shape outdoes, those causes, and what is left is most like.

    A shape outdoes a cause where it explains more of what the other causes leave, and something beside the
    cause, or the cause leaves most of what repeats; where it explains more beside it than twice what the
    cause does; and the least of all causes where it alone explains more than they do together. Of what an
    effect that is there does, a shape explains less, for the price of its freedom.
    found: empty for free motions, which show little but forces that depend on where the arm is; there all
    causes go that leave most of what repeats.
    """
    dropped: list[Cause] = []
    bare, alone = None, -np.inf
    if selection.causes and found:
        bare = System(rows, with_causes(rows, []), selection.system.periods)
        alone = max(worth(shape, bare).evidence for shape in found)
    while True:
        system, causes = selection.system, selection.causes
        beside = [(shape, worth(shape, system)) for shape in found]
        best = max((w.evidence for _, w in beside), default=0.0)
        able = [shape for shape, w in beside if w.evidence > BESIDE]
        doubted = doubtful(selection, rows)
        all_go = bare is not None and bool(causes) and _outdone_together(causes, bare, alone, best)
        lost = [
            c
            for c in causes
            if all_go
            or TWICE * c.delta_bic < best
            or (c in doubted and not found)
            or _replaced(c, causes, rows, system, found if c in doubted else able)
        ]
        if not lost:
            left = [Likeness(s, w.evidence) for s, w in beside if w.evidence > LIKE and w.percent > PRACTICAL]
            return selection, dropped, max(left, key=lambda likeness: likeness.evidence, default=None)
        worst = min(lost, key=lambda c: c.delta_bic)
        dropped.append(worst)
        kept = [c for c in causes if c is not worst]
        system = System(rows, with_causes(rows, [c.trial for c in kept]), system.periods)
        selection = replace(selection, causes=kept, system=system)


def _replaced(
    cause: Cause, causes: Sequence[Cause], rows: Sequence[Rows], system: System, able: Sequence[Shape]
) -> bool:
    """Whether a shape explains more than the cause of what the others leave."""
    if not able:
        return False
    others = [c.trial for c in causes if c is not cause]
    without = System(rows, with_causes(rows, others), system.periods)
    return any(worth(shape, without).evidence > cause.delta_bic for shape in able)


def _outdone_together(causes: Sequence[Cause], bare: System, alone: float, beside: float) -> bool:
    """Whether one shape explains more than all causes together. alone, beside: most that one explains without
    them, and beside them.
    """
    explained = together([c.trial for c in causes], bare)
    if not np.isfinite(explained):
        return False
    more = alone - explained
    if len(causes) > 1:
        return more > -SEARCHED * (len(causes) - 1)
    return more > CLEARLY and beside > BESIDE / 2
