"""What deviations hold beside noise: errors of readings, which move parameters in however many rows."""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.dataset import Prepared
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.identification.rounded_efforts import with_rounding
from modelgen.identification.rounded_positions import with_rounded_positions
from modelgen.identification.unknown_instant import with_unknown_instant
from modelgen.numeric import Array
from modelgen.regression.least_squares import Regression, Solution


def with_reading_errors(
    solution: Solution,
    regression: Regression,
    train: Sequence[Prepared],
    model: Model,
    evaluator: Evaluator,
    added: Sequence[Array] | None = None,
) -> Solution:
    """The solution with what rounding of efforts and positions, and the doubt about the efforts' instant, add
    to its covariance. regression: rows of `train`, all that the solution is of, or a part that moves like
    them. added: as in `regression_of`.
    """
    solution = with_rounding(solution, regression, train, model, evaluator)
    solution = with_rounded_positions(solution, regression, train, model, evaluator, added)
    return with_unknown_instant(solution, regression, train, model, evaluator)
