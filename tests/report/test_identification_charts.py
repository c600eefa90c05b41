"""Charts of identify: what is predicted is drawn where it is judged."""

import numpy as np

from modelgen.identification.objects import Validation
from modelgen.report.identification import predictions


def test_a_residual_has_gaps_where_a_joint_rests() -> None:
    """The error that is stated does not count these samples: drawn, they would contradict it."""
    t = 1.764e9 + np.arange(6) / 10  # the axis counts from the record's begin
    measured = np.array([[0.0, 1.0, 2.0, 5.0, 2.0, 1.0]]).T
    predicted = np.array([[0.0, 1.1, 2.1, 2.0, 1.9, 1.0]]).T
    judged = np.array([[True, True, True, False, True, True]]).T
    found = Validation(
        unit=("A",),
        rmse=np.array([0.08]),
        nrmse_percent=np.array([5.0]),
        rows=np.array([5.0]),
        t=t,
        measured=measured,
        predicted=predicted,
        judged=judged,
    )
    effort, residual = predictions(["j1"], found)
    assert np.isfinite(effort.curves[0].y).all()
    for curve in (*effort.curves, *residual.curves):
        np.testing.assert_allclose(curve.x, np.arange(6) / 10, atol=1e-6)
    for curve, whole in ((effort.curves[1], predicted), (residual.curves[0], measured - predicted)):
        np.testing.assert_array_equal(np.isfinite(curve.y), judged[:, 0])
        np.testing.assert_allclose(curve.y[judged[:, 0]], whole[judged[:, 0], 0])
