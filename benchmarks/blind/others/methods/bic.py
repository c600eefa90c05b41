"""Forward selection by the Bayesian information criterion (Schwarz 1978)."""

from __future__ import annotations

import math

import numpy as np

from blind.case import Array
from blind.others.method import Answer, Method, Problem
from blind.others.regression import Regression

NEGLIGIBLE = 1e-7  # part of a column, of unit length, that the chosen ones leave of it


class ForwardBic(Method):
    """One term after the other, the one that lowers the criterion most, until none lowers it.

    The criterion is the sum of N log(RSS / N) over the joints with N rows each, and log(R) for each of the
    coefficients, searched values counted.
    """

    title = "forward selection (BIC)"
    tuning = "one candidate after the other, until none lowers the criterion; there is nothing to tune"

    def answer(self, problem: Problem) -> Answer:
        """Answer for one case."""
        regression = Regression(problem)
        counts = np.bincount(regression.joint, minlength=problem.n).astype(float)
        price = math.log(len(regression.target))
        columns, left = regression.columns.copy(), regression.target.copy()
        chosen: list[int] = []
        while True:
            best, basis = -1e-9, None
            before = _criterion(left, regression.joint, counts)
            for number in sorted(set(regression.term.tolist()) - set(chosen)):
                own = _basis(columns[:, regression.term == number])
                after = left - own @ (own.T @ left)
                paid = price * (own.shape[1] + problem.terms[number].searched)
                gain = _criterion(after, regression.joint, counts) + paid - before
                if own.shape[1] and gain < best:
                    best, basis, found = gain, own, number
            if basis is None:
                break
            chosen.append(found)
            left = left - basis @ (basis.T @ left)
            columns -= basis @ (basis.T @ columns)
        return regression.answer(np.flatnonzero(np.isin(regression.term, chosen)).tolist())


def _basis(columns: Array) -> Array:
    u, s, _ = np.linalg.svd(columns, full_matrices=False)
    return np.asarray(u[:, s > NEGLIGIBLE])


def _criterion(left: Array, joint: Array, counts: Array) -> float:
    rss = np.bincount(joint, weights=left**2, minlength=len(counts))
    used = counts > 0
    return float(counts[used] @ np.log(np.maximum(rss[used], 1e-300)))


METHOD = ForwardBic()
