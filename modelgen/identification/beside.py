"""Records fitted by the model, and by further columns beside it: what a channel adds to its efforts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from modelgen.dataset import Prepared
from modelgen.evaluation import Evaluator, predicted
from modelgen.functions import Model
from modelgen.identification.rows import motion_of
from modelgen.identification.validation import regression_of
from modelgen.numeric import Array
from modelgen.regression.least_squares import Regression, Solution


@dataclass(frozen=True)
class Added:
    """Of further columns (k,) each: their amount, its standard deviation, and the part of the squares of what
    the model leaves at a joint (n,) that all of them explain together; zeros where an amount is not known.
    covariance: (k, k), of the amounts.
    """

    amount: Array
    std: Array
    share: Array
    covariance: Array

    @property
    def clear(self) -> Array:
        """Standard deviations that each amount is from zero."""
        return np.where(self.std > 0.0, self.amount / np.where(self.std > 0.0, self.std, 1.0), 0.0)


class Beside:
    """Records fitted by the model, and by a further column of each joint beside it."""

    def __init__(self, records: Sequence[Prepared], model: Model, evaluator: Evaluator) -> None:
        self.records, n, p = records, records[0].n, len(model.grouping.base)
        first = regression_of(evaluator, model, records, np.zeros(p))
        self.enough = sum(int(m.sum()) for m in first.moving) >= 3 * (p + n)
        # each joint counts by what is left of it: what one lacks is not sought at others
        theta = first.solve("wls").theta
        own = regression_of(evaluator, model, records, theta)
        theta = own.solve("wls").theta
        self.sigma = np.maximum(_sizes(own, theta), 1e-300)
        self.own, self.p = own, p
        self.efforts = [predicted(evaluator, model, motion_of(r), theta) for r in records]
        gains = [np.ones_like(r.q) if r.gain is None else r.gain for r in records]
        self.gain = np.sqrt(np.mean(np.concatenate(gains) ** 2, axis=0))
        size = np.sqrt(np.mean(np.concatenate(self.efforts) ** 2, axis=0))
        self.logged = size * self.gain
        self.largest = np.maximum(np.max([np.abs(x).max(axis=0) for x in self.efforts], axis=0), 1e-300)

    def explained(self, law: Callable[[Array], Array]) -> Added:
        """What a law of the model's effort over its largest explains at each joint, in unit of the inputs."""
        columns, n = [], self.records[0].n
        for k, r in enumerate(self.records):
            added = np.zeros((len(r.rows), n, n))
            added[:, range(n), range(n)] = r.parallel(law(self.efforts[k] / self.largest) * r.weights)
            columns.append(added)
        found = self.with_columns(columns)
        return replace(found, share=np.where(found.std > 0.0, found.share, 0.0))

    def with_columns(self, added: Sequence[Array]) -> Added:
        """What columns (M, n, k) of each record explain, through the filter."""
        both = self.own.beside(added)
        columns = [table / self.sigma[:, None] for table in both.columns]
        regression = replace(both, effort=[y / self.sigma for y in both.effort], columns=columns)
        solution: Solution = regression.solve("ols")
        amount = solution.theta[self.p :]
        covariance = solution.covariance[self.p :, self.p :]
        std = np.sqrt(np.maximum(np.diag(covariance), 0.0))
        known = solution.determined[self.p :] & (std > 0.0)
        share = 1.0 - _sizes(regression, solution.theta) ** 2
        return Added(np.where(known, amount, 0.0), np.where(known, std, 0.0), share, covariance)


def _sizes(regression: Regression, theta: Array) -> Array:
    """RMS (n,) of what is left of the efforts over the rows that count."""
    left, moving = np.concatenate(regression.residuals(theta)), np.concatenate(regression.moving)
    return np.asarray(np.sqrt((left**2 * moving).sum(axis=0) / np.maximum(moving.sum(axis=0), 1)))
