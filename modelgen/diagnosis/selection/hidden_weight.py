"""What nobody knows of the weight that shows only where gravity is turned.

A base that leans makes parts of the links weigh which no record of the upright arm shows. The description's
nominal inertials stand in for them, and a tilt is wrong by as much as these are.
"""

from __future__ import annotations

import numpy as np

from modelgen.diagnosis.candidates import FittedCandidate
from modelgen.diagnosis.equations import Equations
from modelgen.effects import DescriptionEffect, described
from modelgen.effects.placement import with_effect
from modelgen.numeric import Array


def by_hidden_weight(trial: FittedCandidate, equations: Equations, base: Array) -> list[Array] | None:
    """What one standard deviation of each unknown hidden weight adds to the equations of every record, (M, n,
    h); None where something is hidden and nothing known of it. base: parameters (p,) beside the cause.

    Nominal inertials are as far off as the records say of those that they show.
    """
    c, evaluator = trial.candidate, equations.evaluator
    none = [np.zeros((*r.effort.shape, 0)) for r in equations.rows]
    if not issubclass(c.definition, DescriptionEffect):
        return none
    leaning = described(with_effect(evaluator.arm, c.effect, c.joint, trial.parameters))
    turned = np.subtract(leaning.gravity, described(evaluator.arm).gravity)
    if not turned.any():
        return none
    hidden = evaluator.hidden_weight
    tables = [r.filtered(hidden.by_scale(r.motion, turned)) for r in equations.rows]
    if not any(t.any() for t in tables):
        return none
    said = equations.rows[0].baseline.said
    if not hidden.known or said is None:
        return None
    scale = equations.thresholds.equations.nominal_scatter * said.scatter(base)
    return [scale * t for t in tables]
