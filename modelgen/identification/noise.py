"""How far measured inputs are from those of a model, along records that were not fitted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset import Prepared
from modelgen.numeric import Array
from modelgen.options.noise import Noise

UNCORRELATED = 0.05  # of the variance: where the sum of an autocorrelation ends


def noise_of(
    records: Sequence[Prepared], residuals: Sequence[Array], moving: Sequence[NDArray[np.bool_]]
) -> Noise:
    """By record: residuals (M, n) in the unit of the inputs, and rows (M, n) at which the joints move.

    The largest errors are those of all rows: where a joint turns back or rests, dry friction is undetermined.
    """
    n = residuals[0].shape[1]
    step = float(np.median(np.diff(records[0].t)))
    rms, largest, correlation = [], [], []
    for j in range(n):
        flags = [m[:, j] if any(m[:, j].any() for m in moving) else np.ones(len(m), bool) for m in moving]
        parts = [np.where(m, e[:, j], 0.0) for e, m in zip(residuals, flags, strict=True)]
        count = max(1, sum(int(m.sum()) for m in flags))
        power = sum(float(e @ e) for e in parts) / count
        rms.append(float(np.sqrt(power)))
        largest.append(max(float(np.abs(e[:, j]).max()) for e in residuals))
        correlation.append(step * _correlated(parts, power * count))
    settings = records[0].settings
    return Noise(
        tuple(rms),
        tuple(largest),
        tuple(correlation),
        tuple(float(gate) for gate in settings.gates),
        float(settings.cutoff),
        step * sum(len(e) for e in residuals),
    )


def _correlated(parts: Sequence[Array], power: float) -> float:
    """Rows that go together: 1 + 2 (sum of the autocorrelation), up to where it is lost."""
    total = 1.0
    for lag in range(1, max(len(e) for e in parts) // 2):
        share = sum(float(e[lag:] @ e[:-lag]) for e in parts if len(e) > lag) / max(power, 1e-300)
        if share < UNCORRELATED:
            break
        total += 2.0 * share
    return total
