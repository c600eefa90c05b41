"""Essential parameters: those that the records support."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from modelgen.regression.least_squares import Regression, Solution

NEEDED = 2.0  # standard deviations that a parameter of the data's support is away from zero


def essential(solution: Solution) -> NDArray[np.bool_]:
    """Flags (p,) of the parameters that backward elimination leaves.

    The least significant goes first; the others then take its part over by their covariance.
    """
    theta, v = solution.theta.copy(), solution.covariance.copy()
    left = list(np.flatnonzero(solution.determined & (np.diag(v) > 0)))
    flags = solution.determined.copy()
    while left:
        k = min(left, key=lambda i: theta[i] ** 2 / v[i, i])
        if theta[k] ** 2 >= NEEDED**2 * v[k, k]:
            break
        column, size = v[:, k].copy(), v[k, k]
        theta = theta - column * (theta[k] / size)
        v = v - np.outer(column, column) / size
        flags[k] = False
        left = [i for i in left if i != k and v[i, i] > 0]
    return np.asarray(flags)


def only(regression: Regression, solution: Solution, method: str) -> Solution:
    """The fit with the essential parameters alone, until all that are left are essential.

    The others are zero and not `determined`; method: as for `Regression.solve`.
    """
    return refit(solution, lambda kept: part(regression, kept).solve(method))


def refit(solution: Solution, fit: Callable[[NDArray[np.bool_]], Solution]) -> Solution:
    """Elimination and fit in turn. fit: from flags (p,) to the solution of those columns alone."""
    size = len(solution.theta)
    while True:
        kept = essential(solution) & solution.determined
        if (kept == solution.determined).all() or not kept.any():
            return solution
        found = fit(kept)
        theta, known = np.zeros(size), np.zeros(size, dtype=bool)
        covariance, precision = np.zeros((size, size)), np.zeros((size, size))
        theta[kept], known[kept] = found.theta, found.determined
        covariance[np.ix_(kept, kept)], precision[np.ix_(kept, kept)] = found.covariance, found.precision
        solution = replace(
            found,
            theta=theta,
            covariance=covariance,
            determined=known,
            precision=precision,
            left_out=solution.dropped | (solution.determined & ~kept),
        )


def part(regression: Regression, kept: NDArray[np.bool_]) -> Regression:
    """The regression with some of its columns, flags (p,)."""
    return replace(regression, columns=[c[:, :, kept] for c in regression.columns])
