"""Stiffness of elastic joints beside the arm's parameters.

What an elastic joint adds to the inputs follows from the efforts that it transmits, and these from parameters
that took over some of what it does while it was not known: a link that seemed half as heavy lets a joint seem
twice as soft. Both are found in turns, half a step each (Richardson's iteration, damped), until as much of
what was simulated is found as was simulated.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modelgen.diagnosis.candidates import FittedCandidate, candidate_columns, system_of, with_causes
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.selection.cause import Selection
from modelgen.effects import Shows
from modelgen.numeric import Array
from modelgen.regression.weighted import weighted_fit

# When the turns end: how finely values are found decides nothing.
TURNS = 16
CLOSE = 0.01  # of what was simulated, that is found more or less of it
LEAST, MOST = 0.2, 5.0  # times what was simulated, that count of what is found in a turn


def refit_stiffness(selection: Selection, equations: Equations) -> Selection:
    """The selection with the stiffness of its elastic joints found anew; as it was where that has no end."""
    causes = selection.causes
    rows, own = equations.rows, equations.unknowns
    laws = [c.trial.candidate for c in causes]
    # what rattles is found beside the parameters as it is selected: of its share nothing follows
    elastic = [k for k, c in enumerate(laws) if c.elastic and Shows.IMPACTS not in c.definition.shows]
    if not elastic:
        return selection
    trials = [c.trial for c in causes]
    theta = weighted_fit(rows, equations.columns)
    for _ in range(TURNS):
        base = equations.base(theta)
        for k in elastic:
            found = candidate_columns(trials[k].candidate, trials[k].values, equations, base)
            if found is None or not all(np.isfinite(c).all() for c in found):
                return selection
            trials[k] = replace(trials[k], columns=found)
        fitted = weighted_fit(rows, with_causes(equations, trials))
        shares = [_share(trials, k, fitted[own:]) for k in elastic]
        if max(abs(share - 1.0) for share in shares) < CLOSE:
            return with_trials(selection, trials, equations)
        for k, share in zip(elastic, shares, strict=True):
            softer = math.sqrt(min(max(share, LEAST), MOST))
            values = {**trials[k].values, "stiffness": trials[k].values["stiffness"] / softer}
            trials[k] = replace(trials[k], values=values)
        theta = (theta + fitted[:own]) / 2
    return selection


def _share(trials: Sequence[FittedCandidate], which: int, values: Array) -> float:
    """Share of an elastic joint's column that is found. values: of all trials' columns in turn."""
    return float(values[sum(t.columns[0].shape[2] for t in trials[:which])])


def with_trials(selection: Selection, trials: Sequence[FittedCandidate], equations: Equations) -> Selection:
    """The selection with other values of its causes, in these equations."""
    system = system_of(equations, trials)
    causes = [replace(c, trial=t) for c, t in zip(selection.causes, trials, strict=True)]
    return replace(selection, causes=causes, system=system)
