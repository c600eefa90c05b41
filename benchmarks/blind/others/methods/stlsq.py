"""Sequentially thresholded least squares (Brunton, Proctor and Kutz 2016), by PySINDy."""

from __future__ import annotations

import warnings

import numpy as np

from blind.case import Array
from blind.others.method import Answer, Method, Problem
from blind.others.regression import Regression, held_out, sparsest, without

THRESHOLDS = np.geomspace(0.003, 1.0, 20)  # of the length of the target, columns of unit length


class Stlsq(Method):
    """Small coefficients of a ridge regression become zero, the rest is fitted again, until none is small."""

    title = "STLSQ (PySINDy)"
    tuning = (
        "sequentially thresholded least squares; columns of unit length, PySINDy's usual ridge, the largest "
        "threshold within one standard error of the least error on 10 held-out blocks of time"
    )

    def answer(self, problem: Problem) -> Answer:
        """Answer for one case."""
        regression = Regression(problem)
        parts = regression.compressed()
        errors = np.array(
            [
                [held_out(parts, b, thresholded(*without(parts, b), limit)) for b in range(len(parts))]
                for limit in THRESHOLDS
            ]
        )
        limit = THRESHOLDS[sparsest(errors)]
        values = thresholded(regression.columns, regression.target, limit)
        return regression.answer(np.flatnonzero(values).tolist())


def thresholded(columns: Array, target: Array, limit: float) -> Array:
    """Coefficients (K,) of columns (R, K), zeros among them. The outcome depends on the sums of squares of
    the equations alone.
    """
    from pysindy import STLSQ  # noqa: PLC0415, an extra

    optimizer = STLSQ(threshold=limit, normalize_columns=True)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # no coefficient is above the threshold, or not in 20 turns
        optimizer.fit(columns, target[:, None])
    return np.asarray(optimizer.coef_[0])


METHOD = Stlsq()
