"""A ladder of friction models, one rung of which is picked at each joint by the error on rows held out."""

from __future__ import annotations

import numpy as np

from blind.case import Array
from blind.others.method import Answer, Method, Problem
from blind.others.regression import Regression, held_out, without

# laws beside the user's own, as reviews list them: Armstrong, Dupont and Canudas 1994; Bittencourt and
# Gunnarsson 2012; Bona and Indri 2005
RUNGS = (
    "viscous_friction",
    "coulomb_friction",
    "friction_offset",
    "asymmetric_viscous_friction",
    "stribeck_friction",
    "nonlinear_viscous_friction",
    "load_dependent_friction",
    "position_dependent_friction",
    "presliding",
    "friction_warm_up",
)


class Ladder(Method):
    """At each joint the law that lowers the held-out error most, if by more than its standard error."""

    title = "ladder of friction models"
    tuning = (
        "at most one law a joint: that of the least error on 10 held-out blocks of time, if by more than the "
        "standard error below that without it"
    )

    def answer(self, problem: Problem) -> Answer:
        """Answer for one case."""
        regression = Regression(problem)
        parts = regression.compressed()
        nothing = _errors(parts, [])
        chosen: list[int] = []
        for joint in range(1, problem.n + 1):
            better: dict[tuple[int, ...], float] = {}
            for number, term in enumerate(problem.terms):
                columns = np.flatnonzero(regression.term == number).tolist()
                if term.joint != joint or term.effect not in RUNGS or not columns:
                    continue
                less = nothing - _errors(parts, columns)
                if less.mean() > less.std(ddof=1) / np.sqrt(len(less)):
                    better[tuple(columns)] = float(less.mean())
            if better:
                best = max(better, key=better.__getitem__)
                chosen += best
        return regression.answer(chosen)


def _errors(parts: list[Array], columns: list[int]) -> Array:
    """Sums of squares of each block that a fit of these columns to the others leaves."""
    found = []
    for block in range(len(parts)):
        left, right = without([p[:, [*columns, -1]] for p in parts], block)
        values = np.zeros(parts[0].shape[1] - 1)
        values[columns] = np.linalg.lstsq(left, right, rcond=1e-9)[0]
        found.append(held_out(parts, block, values))
    return np.array(found)


METHOD = Ladder()
