"""What parameters may be off by where nobody knows when the efforts were read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modelgen.dataset import Prepared
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.identification.rounded_efforts import ideal
from modelgen.regression.least_squares import Regression, Solution


def with_unknown_instant(
    solution: Solution, regression: Regression, train: Sequence[Prepared], model: Model, evaluator: Evaluator
) -> Solution:
    """The solution with what the doubt about the efforts' instant adds to its covariance.

    All efforts are read too early or too late by the same time, which the records may be off by
    (`Record.hold_std`): the model's own efforts then differ by their rate times that, and it moves the
    parameters by what a fit to this difference has.
    """
    if not any(p.record.hold_std for p in train):
        return solution
    weights = 1.0 / np.maximum(solution.sigma, 1e-300)
    kept = solution.determined & ~solution.dropped
    columns = [c[:, :, kept] * weights[:, None] for c in regression.columns]
    errors = []
    for p in train:
        rate = np.gradient(ideal(p, model, evaluator, solution.theta), p.time, axis=0)
        errors.append(np.asarray(p.parallel(p.record.hold_std * rate * p.weights)) * weights)
    moved = Regression(errors, columns, regression.moving).least_squares()
    covariance = solution.covariance.copy()
    covariance[np.ix_(kept, kept)] += np.outer(moved, moved)
    return replace(solution, covariance=covariance)
