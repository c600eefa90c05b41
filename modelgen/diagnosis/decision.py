"""From the equations of one band to a verdict: causes are selected and held against functions of no law."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from modelgen.dataset.processing.instants import EffortInstant
from modelgen.diagnosis.adequacy import (
    Examined,
    Remains,
    aliases,
    examined,
    instant_beside_elastic,
    instant_shown,
    lack_of_fit,
    most_like,
    verdict_of,
    without_indistinguishable,
)
from modelgen.diagnosis.candidates import Candidate, Place, asked, at_motor, candidates
from modelgen.diagnosis.equations import Band, Equations, feigned, harmless
from modelgen.diagnosis.evidence import Endogeneity, endogeneity, mean_squares
from modelgen.diagnosis.options import Options
from modelgen.diagnosis.selection import (
    SUSPECT,
    Selection,
    beside_hidden_weight,
    doubtful_joints,
    forward_selection,
    paired,
    with_pair,
    with_rival,
)
from modelgen.identification.drifting import BENT, drifting
from modelgen.identification.objects import Doubt
from modelgen.jobs import Where
from modelgen.numeric import Array

Progress = Callable[[str, int, int], None]


@dataclass(frozen=True)
class Decision:
    """What one band says.

    causes: those of the selection with their checks; suspects: what failed one of them, in the order in which
    it was chosen; before: the selection with the suspects; equal: aliases of every cause; remains: what the
    causes leave; correlated: what the test of Durbin, Wu and Hausman says,
    whether it has a say or not.
    """

    band: Band
    selection: Selection
    causes: Sequence[Examined]
    suspects: Sequence[Examined]
    before: Selection
    equal: Sequence[Sequence[Candidate]]
    remains: Remains
    correlated: Endogeneity | None
    verdict: str
    reason: str

    def instant(self) -> EffortInstant | None:
        """When the efforts were read, where a suspect says it that is only the log's, or an elastic joint."""
        alone = [e.cause for e in self.suspects if [c.name for c in e.failed] == ["admissible"]]
        shown = instant_shown(alone, self.before, self.band.equations)
        return shown or instant_beside_elastic(self.selection, self.band.equations)


def decide(band: Band, options: Options, progress: Progress | None = None) -> Decision:
    """What these equations say. Raises InputError where none of the effects can be asked for."""
    equations = band.equations
    pool = tried = _pool(band, options)
    while True:
        selection = forward_selection(equations, tried, progress, options.where)
        selection, every = in_pairs(selection, tried, equations, progress, options.where)
        before = selection
        suspects = [e for e in every if e.failed]
        selection = selection.without([e.cause for e in suspects], SUSPECT) if suspects else selection
        named = [c.trial.candidate for c in selection.causes]
        equal = aliases(named, pool, equations, selection.system.base) if named else []
        twice = _said_twice(named, equal)
        if not twice:
            break
        tried = [c for c in tried if c.place not in twice]
    selection, unclear = without_indistinguishable(selection, equal)
    if unclear:
        equal = []
    selection = beside_hidden_weight(selection)
    system = selection.system
    fit, correlated, left = lack_of_fit(system), endogeneity(system), mean_squares(system)
    remains = Remains(
        suspects=suspects,
        unclear=unclear,
        fit=fit,
        feigned=feigned(equations.blur, left),
        correlated=None if harmless(equations, left) else correlated,
        likeness=None if unclear else most_like(system, suspects, fit),
        counted=equations.free and fit is None and _counted(equations, left),
        asked=bool(options.effects),
        drifting=() if selection.causes or suspects else _drifting(equations),
    )
    verdict, reason = verdict_of(selection, remains)
    causes = [e for e in every if any(e.cause.trial.candidate == c.trial.candidate for c in selection.causes)]
    return Decision(band, selection, causes, suspects, before, equal, remains, correlated, verdict, reason)


def _drifting(equations: Equations) -> list[Doubt]:
    """Questions about joints whose efforts change against the model's as time goes by."""
    if equations.free:
        return []
    train = [r.prepared.with_turns() for r in equations.rows]
    found = drifting(train, equations.model, equations.evaluator, BENT)
    return [found[j] for j in sorted(found)]


def _said_twice(named: Sequence[Candidate], equal: Sequence[Sequence[Candidate]]) -> set[Place]:
    """Causes that are aliases of one named before them: what no motion tells apart explains nothing twice.

    Only the little in which large values of them differ, of the other sign each, would be explained: no law
    of theirs.
    """
    places = [c.place for c in named]
    return {
        place
        for k, place in enumerate(places)
        if any(place == other.place for before in equal[:k] for other in before)
    }


def in_pairs(
    selection: Selection,
    pool: Sequence[Candidate],
    equations: Equations,
    progress: Progress | None,
    where: Where,
) -> tuple[Selection, list[Examined]]:
    """The selection with its checks; with a pair of causes at a joint where that explains more by what makes
    a rival none, or more and leaves fewer that fail a check. Where neither is ahead, each is a rival.

    Steps that chose one cause after the other may have gone astray where a cause is a suspect, or is one that
    is confused with what follows the load.
    """
    every = examined(selection, equations)
    margin = equations.thresholds.selection.rival_margin_bic
    for joint in doubtful_joints(selection.causes, [e.cause for e in every if e.failed], pool, equations):
        found = paired(selection.causes, joint, pool, equations, where)
        if found is None or found[0] < -margin:
            continue
        ahead, causes = found
        suspects = [e.cause for e in every if e.failed]
        if ahead > 0.0:
            start = with_pair(selection, causes, suspects, equations)
            tried = forward_selection(equations, pool, progress, where, start)
            checked = examined(tried, equations)
            if ahead > margin or sum(bool(e.failed) for e in checked) < len(suspects):
                selection, every = tried, checked
                continue
        selection = with_rival(selection, causes[-2:], ahead)
        every = examined(selection, equations)
    return selection, every


def _pool(band: Band, options: Options) -> list[Candidate]:
    """The candidates to ask: behind a link's own encoder low-passed positions look like elastic joints."""
    equations = band.equations
    pool = [
        c
        for c in candidates(equations)
        if not c.elastic or not equations.coarse or at_motor(c.joint, equations.rows)
    ]
    return asked(pool, options.effects, band)


def _counted(equations: Equations, left: Array) -> bool:
    """Whether what is left, mean squares by joint (n,), is no more than what the encoders' counts leave."""
    moving = np.any([r.moving.any(axis=0) for r in equations.rows], axis=0)
    most = equations.thresholds.adequacy.max_counts_ratio**2
    return bool((left <= most * equations.blur)[moving].all())
