"""Forward regression by orthogonal least squares (Chen, Billings and Luo 1989), by SysIdentPy's FROLS."""

from __future__ import annotations

import warnings

import numpy as np

from blind.case import Array
from blind.others.method import Answer, Method, Problem
from blind.others.regression import Regression

MOST = 20  # terms that the criterion is computed for


class Frols(Method):
    """One column after the other, the one with the largest error reduction ratio; BIC says how many."""

    title = "FROLS (SysIdentPy)"
    tuning = f"orthogonal forward regression; as many columns, up to {MOST}, as SysIdentPy finds by BIC"

    def answer(self, problem: Problem) -> Answer:
        """Answer for one case."""
        regression = Regression(problem)
        return regression.answer(reduced(regression.columns, regression.target))


def reduced(columns: Array, target: Array) -> list[int]:
    """Indices of the columns (R, K) that are chosen for a target (R,)."""
    from sysidentpy.basis_function import Polynomial  # noqa: PLC0415, an extra
    from sysidentpy.model_structure_selection import FROLS  # noqa: PLC0415
    from sysidentpy.parameter_estimation import LeastSquares  # noqa: PLC0415

    count = columns.shape[1]
    model = FROLS(
        order_selection=True,
        info_criteria="bic",
        n_info_values=min(MOST, count),
        xlag=[[1]] * count,
        ylag=1,
        estimator=LeastSquares(),
        basis_function=Polynomial(degree=1),
        model_type="NFIR",
    )
    # an input acts one sample later there: the target waits for it
    inputs = np.vstack([columns, np.zeros((1, count))])
    output = np.append(0.0, target)[:, None]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model.fit(X=inputs, y=output)
    codes = np.asarray(model.final_model)[:, 0].astype(int)
    return sorted(int(code) // 1000 - 2 for code in codes if code)  # 2001 is the first input, 0 a constant


METHOD = Frols()
