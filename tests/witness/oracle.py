"""What the regressor of the witnesses spans."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from modelgen.description import Arm
from witness.mechanism import Mechanism, states

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Span:
    """Rank, and the singular values, relative to the largest, on either side of the gap."""

    rank: int
    last: float
    next: float


def efforts(arm: Arm, seed: int = 3, samples: int | None = None) -> tuple[Array, list[str]]:
    """Regressor at random states: samples x n x standard parameters, as efforts, and their names.

    Efforts, since a row in amperes takes another unit without another meaning.
    """
    mechanism = Mechanism(arm)
    names, n = mechanism.names(), len(mechanism.moving)
    count = samples or max(8 * n, 3 * len(names) // n + 10)
    q, dq, ddq = states(arm, count, seed)
    return mechanism.regressor(q, dq, ddq) * mechanism.gains(q)[:, :, None], names


def span(matrix: Array) -> Span:
    """Rank of rows x columns, columns scaled to unit length; what is only rounding counts as zero."""
    present = matrix[:, np.abs(matrix).max(axis=0) > 1e-9]
    values = np.linalg.svd(present / np.linalg.norm(present, axis=0), compute_uv=False)
    values = np.append(values / values[0], 0.0)
    rank = int(np.argmax(values < 1e-9))
    return Span(rank, float(values[rank - 1]), float(values[rank]))
