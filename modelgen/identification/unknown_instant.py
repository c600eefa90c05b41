"""What parameters may be off by where nobody knows when the efforts were read."""

from __future__ import annotations

from collections.abc import Sequence

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
    errors = []
    for p in train:
        rate = np.gradient(ideal(p, model, evaluator, solution.theta), p.time, axis=0)
        errors.append(np.asarray(p.parallel(p.record.hold_std * rate * p.weights)))
    return solution.uncertain_by([regression.moved_by(solution, errors)])
