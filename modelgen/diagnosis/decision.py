"""From equations to verdict: causes are selected and tried against functions of no law."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from modelgen.diagnosis.adequacy.distinguishable import aliases, without_indistinguishable
from modelgen.diagnosis.adequacy.lack_of_fit import LackOfFit, lack_of_fit
from modelgen.diagnosis.adequacy.smooth_functions import smooth_functions
from modelgen.diagnosis.adequacy.stand_ins import Likeness, without_stand_ins
from modelgen.diagnosis.adequacy.verdict import verdict_of
from modelgen.diagnosis.candidates.candidate import Candidate, Place, at_motor, candidates
from modelgen.diagnosis.candidates.requested import asked
from modelgen.diagnosis.equations.band import Equations
from modelgen.diagnosis.equations.position_errors import feigned, harmless
from modelgen.diagnosis.evidence.instruments import Endogeneity, endogeneity
from modelgen.diagnosis.evidence.system import mean_squares
from modelgen.diagnosis.selection.cause import Selection
from modelgen.diagnosis.selection.stepwise import forward_selection
from modelgen.diagnosis.thresholds import PRACTICAL
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.jobs import HERE, Where
from modelgen.numeric import Array

Progress = Callable[[str, int, int], None]
# Times what the encoders' counts leave: a larger RMSE of a free motion has something else in it.
COUNTED = 1.25


@dataclass(frozen=True)
class Decision:
    """made: the equations that were asked. equal: aliases of every cause. share: percent of the RMSE by
    joint (n,) that errors of the positions could feign in what is left.
    """

    made: Equations
    selection: Selection
    equal: Sequence[Sequence[Candidate]]
    verdict: str
    reason: str
    fit: LackOfFit | None
    likeness: Likeness | None
    share: Array
    noisy: Endogeneity | None


def decide(
    made: Equations,
    model: Model,
    evaluator: Evaluator,
    effects: Sequence[Place],
    progress: Progress | None,
    where: Where = HERE,
) -> Decision:
    """What these equations say. effects: to be asked for alone; all of the catalogue where there are none.

    Raises InputError where none of the effects can be asked for.
    """
    rows, blurs = made.rows, made.blur
    baseline, free = rows[0].baseline, rows[0].prepared.input is None

    def base(found: Selection) -> Array:
        return baseline.base(found.system.theta[: rows[0].columns.shape[2]])

    pool: Sequence[Candidate] = [
        c
        for c in candidates(evaluator, rows)
        if not c.elastic or made.narrowed == 1.0 or at_motor(c.joint, rows)
    ]
    pool = asked(pool, effects, rows, evaluator, baseline.base(made.theta))
    selection = forward_selection(
        rows, evaluator, pool, made.periods, progress, blur=blurs, narrowed=made.narrowed, where=where
    )
    tried = [] if free else list(smooth_functions(rows, evaluator, base(selection)))
    selection, beside, likeness = without_stand_ins(selection, rows, tried)
    named = [c.trial.candidate for c in selection.causes]
    equal = aliases(named, pool, evaluator, model, base(selection)) if named else []
    selection, close = without_indistinguishable(selection, equal, made.narrowed)
    if close:
        equal, likeness = [], None
    fit, noisy = lack_of_fit(selection.system), endogeneity(selection.system)
    left = mean_squares(selection.system)
    share = feigned(blurs, left)
    moving = np.any([r.moving.any(axis=0) for r in rows], axis=0)
    counted = free and fit is None and bool((left <= COUNTED**2 * blurs)[moving].all())
    tested = None if harmless(rows, blurs, left, PRACTICAL) else noisy
    verdict, reason = verdict_of(
        selection, beside, close, fit, share, tested, likeness, counted=counted, asked=bool(effects)
    )
    return Decision(made, selection, equal, verdict, reason, fit, likeness, share, noisy)
