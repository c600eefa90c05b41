"""Values of elastic joints together with the arm's parameters.

What an elastic joint adds to the inputs follows from the efforts that it transmits, and these from parameters
that took over some of what it does while it was not known: a link that seemed half as heavy lets a joint seem
twice as soft. The values and all parameters are unknowns of one least squares problem, solved by Gauss's and
Newton's steps within a trust region (Branch, Coleman and Li 1999), its slopes by differences.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import least_squares

from modelgen.diagnosis.candidates import FittedCandidate, at_links, candidate_columns, with_causes
from modelgen.diagnosis.equations import Equations
from modelgen.effects import Shows
from modelgen.numeric import Array
from modelgen.regression.weighted import stacked, weighted_fit, weights_of

# How finely values are found decides nothing.
STEPS = 12
CLOSE = 1e-4  # of what is left, of a value
TOUCH = 1e-4  # of a parameter, over which slopes are taken; of a value, in logarithms
LEAST = 1e-7  # of a parameter's own unit
ASTRAY = 1e6  # times what a rigid joint leaves, where nothing can be simulated


def elastic(trial: FittedCandidate) -> bool:
    """Whether it is an elastic joint, and no gap: of what rattles nothing follows from a slope."""
    c = trial.candidate
    return c.elastic and bool(trial.values) and Shows.IMPACTS not in c.definition.shows


def smooth(trial: FittedCandidate, equations: Equations) -> bool:
    """Whether it is an elastic joint whose drive's position was measured: slopes by the arm's parameters tell
    what it does.
    """
    return elastic(trial) and not at_links(trial.candidate.joint, equations.rows)


class ElasticFit:
    """Elastic joints beside an arm, and beside causes whose columns stay.

    moving: the elastic joints, with the values that a fit begins at. beside: the other causes.
    """

    def __init__(
        self, equations: Equations, moving: Sequence[FittedCandidate], beside: Sequence[FittedCandidate]
    ) -> None:
        self.equations, self.moving, rows = equations, moving, equations.rows
        table, whole = with_causes(equations, beside), with_causes(equations, [*beside, *moving])
        self.weights = weights_of(rows, whole, weighted_fit(rows, whole))
        self.left, self.right = stacked(rows, table, self.weights)
        self.first = weighted_fit(rows, table)
        self.names = [(k, name) for k, t in enumerate(moving) for name in sorted(t.values)]

    def fit(self, theta: Array | None = None) -> tuple[list[FittedCandidate], Array]:
        """The elastic joints with the values that leave least, and the unknowns beside them.

        They stay as they were where nothing can be simulated. theta: unknowns to begin at, by default those
        of a rigid arm.
        """
        count = len(self.names)
        begin = np.log([self.moving[k].values[name] for k, name in self.names])
        first = np.concatenate([begin, self.first if theta is None else theta])
        last: list[tuple[Array, Array]] = []
        rigid = float(np.abs(self.right - self.left @ self.first).max(initial=0.0))

        def simulated(x: Array) -> Array | None:
            if last and np.array_equal(last[0][0], x):
                return last[0][1]
            found = self._simulated(self._values(x[:count]), x[count:])
            if found is not None:
                last[:] = [(x.copy(), found)]
            return found

        def wrong(x: Array) -> Array:
            found = simulated(x)
            if found is None:
                return np.full(len(self.right), ASTRAY * rigid)
            return np.asarray(self.right - self.left @ x[count:] - found)

        def slopes(x: Array) -> Array:
            here = simulated(x)
            table = np.hstack([np.zeros((len(self.right), count)), self.left])
            if here is None:
                return -table
            for i in range(count + self.equations.unknowns):
                moved, step = x.copy(), TOUCH
                if i >= count:
                    step = max(TOUCH * abs(float(x[i])), LEAST)
                moved[i] += step
                there = self._simulated(self._values(moved[:count]), moved[count:])
                if there is not None:
                    table[:, i] += (there - here) / step
            return -table

        if simulated(first) is None:
            return list(self.moving), first[count:]
        found = least_squares(
            wrong, first, slopes, x_scale="jac", ftol=CLOSE, xtol=CLOSE, gtol=None, max_nfev=STEPS
        )
        return self._trials(found.x[:count], found.x[count:]), found.x[count:]

    def _values(self, logarithms: Array) -> list[dict[str, float]]:
        values = [dict(t.values) for t in self.moving]
        for (k, name), x in zip(self.names, logarithms, strict=True):
            values[k][name] = float(np.exp(x))
        return values

    def _trials(self, logarithms: Array, theta: Array) -> list[FittedCandidate]:
        base, found = self.equations.base(theta), []
        for trial, values in zip(self.moving, self._values(logarithms), strict=True):
            made = candidate_columns(trial.candidate, values, self.equations, base, ringing=True)
            found.append(trial if made is None else replace(trial, values=values, columns=made))
        return found

    def _simulated(self, values: Sequence[dict[str, float]], theta: Array) -> Array | None:
        """What all of them add, stacked; None where it cannot be."""
        base, found = self.equations.base(theta), np.zeros(len(self.right))
        for trial, given in zip(self.moving, values, strict=True):
            made = candidate_columns(trial.candidate, given, self.equations, base, ringing=True)
            if made is None or not all(np.isfinite(c).all() for c in made):
                return None
            found += stacked(self.equations.rows, made, self.weights)[0][:, 0]
        return found
