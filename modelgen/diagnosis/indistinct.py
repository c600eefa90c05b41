"""Causes that coarse positions do not tell from others.

Evidence is that of equations whose regressor is known. Errors of the positions bend it, for one law more than
for another: of two that are close the wrong one may come out ahead, however much both explain.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from modelgen.diagnosis.candidates import Candidate
from modelgen.diagnosis.causes import Cause
from modelgen.diagnosis.compliance import alternatives
from modelgen.diagnosis.forms import with_causes
from modelgen.diagnosis.ranking import COARSE
from modelgen.diagnosis.selection import RATHER, Selection
from modelgen.diagnosis.system import System
from modelgen.diagnosis.trials import Trial, beside


def indistinct(
    selection: Selection, equal: Sequence[Sequence[Candidate]], narrowed: float
) -> tuple[Selection, list[Cause]]:
    """The selection, with no cause at all where rivals come close to some, and these with such rivals alone.

    What the other causes explain depends on which of them it is. In the usual band none is lost. Aliases say
    the same thing, and so does a law with more freedom that holds the cause's own and makes no use of it.
    equal: aliases of every cause; narrowed: the usual band over that of the equations.
    """
    if narrowed == 1.0:
        return selection, []
    found = []
    for cause, same in zip(selection.causes, equal, strict=True):
        places = [other.place for other in same]
        near = [(t, by) for t, by in cause.rivals if by <= RATHER and t.candidate.place not in places]
        rivals = [(t, by) for t, by in near if not _the_same(t, cause, selection)]
        if rivals:
            found.append(replace(cause, rivals=rivals))
    return (selection.without(selection.causes, COARSE), found) if found else (selection, [])


def _the_same(rival: Trial, cause: Cause, selection: Selection) -> bool:
    """Whether the cause adds nothing to the rival in its place, or the two are an elastic joint and a gap,
    which are told apart by what they carry to other records.
    """
    if alternatives(rival.candidate, cause.trial.candidate):
        return True
    rows = selection.system.rows
    others = [c.trial for c in selection.causes if c is not cause]
    system = System(rows, with_causes(rows, [*others, rival]), selection.system.periods)
    return beside(cause.trial, system) is None
