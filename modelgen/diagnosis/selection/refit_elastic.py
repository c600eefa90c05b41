"""Values of elastic joints found anew, together with the arm's parameters.

Where a drive's position was measured they are those of `ElasticFit`. Behind a link's own position the drive
does what the link transmits over the stiffness: how much of what was simulated is found says how much softer
the joint is. Both it and the parameters are found in turns, half a step each (Richardson's damped iteration),
until all of it is found: what holds the noise of the positions is never a slope by the parameters as well.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modelgen.diagnosis.candidates import FittedCandidate, candidate_columns, with_causes
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.selection.cause import Selection, with_trials
from modelgen.diagnosis.selection.elastic_fit import ElasticFit, elastic, smooth
from modelgen.numeric import Array
from modelgen.regression.weighted import weighted_fit

# When the turns end: how finely values are found decides nothing.
TURNS = 16
CLOSE = 0.01  # of what was simulated, that is found more or less of it
LEAST, MOST = 0.2, 5.0  # times what was simulated, that count of what is found in a turn


def refit_elastic(selection: Selection, equations: Equations) -> Selection:
    """The selection with the values of its elastic joints found anew, together with the arm's parameters."""
    return _behind_links(_at_motors(selection, equations), equations)


def effort_rates(selection: Selection, equations: Equations) -> list[Array]:
    """Rate (M, n) of the efforts of every record, as the model with its elastic joints has them."""
    evaluator, base, found = equations.evaluator, selection.system.base, []
    for r in equations.rows:
        inputs = evaluator.inputs(r.motion, base)
        for cause in selection.causes:
            c = cause.trial.candidate
            if c.elastic:
                given = cause.trial.parameters
                inputs = inputs + evaluator.contribution(c.effect, c.joint, r.motion, given, base)
        found.append(r.filtered(np.gradient(inputs, r.prepared.time, axis=0)[:, :, None])[:, :, 0])
    return found


def _at_motors(selection: Selection, equations: Equations) -> Selection:
    trials = [c.trial for c in selection.causes]
    moving = [t for t in trials if smooth(t, equations)]
    if not moving:
        return selection
    beside = [t for t in trials if not smooth(t, equations)]
    anew = iter(ElasticFit(equations, moving, beside).fit()[0])
    return with_trials(selection, [next(anew) if smooth(t, equations) else t for t in trials], equations)


def _behind_links(selection: Selection, equations: Equations) -> Selection:
    """As it was where the turns have no end."""
    rows, own = equations.rows, equations.unknowns
    trials = [c.trial for c in selection.causes]
    behind = [k for k, t in enumerate(trials) if elastic(t) and not smooth(t, equations)]
    if not behind:
        return selection
    theta = weighted_fit(rows, equations.columns)
    for _ in range(TURNS):
        base = equations.base(theta)
        for k in behind:
            found = candidate_columns(trials[k].candidate, trials[k].values, equations, base)
            if found is None or not all(np.isfinite(c).all() for c in found):
                return selection
            trials[k] = replace(trials[k], columns=found)
        fitted = weighted_fit(rows, with_causes(equations, trials))
        shares = [_share(trials, k, fitted[own:]) for k in behind]
        if max(abs(share - 1.0) for share in shares) < CLOSE:
            return with_trials(selection, trials, equations)
        for k, share in zip(behind, shares, strict=True):
            softer = math.sqrt(min(max(share, LEAST), MOST))
            values = {**trials[k].values, "stiffness": trials[k].values["stiffness"] / softer}
            trials[k] = replace(trials[k], values=values)
        theta = (theta + fitted[:own]) / 2
    return selection


def _share(trials: Sequence[FittedCandidate], which: int, values: Array) -> float:
    """Share of an elastic joint's column that is found. values: of all trials' columns in turn."""
    return float(values[sum(t.columns[0].shape[2] for t in trials[:which])])
