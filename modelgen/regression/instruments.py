"""Instruments: regressors with the same truth and other errors (Reiersoel 1945)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset.processing.periods import other_period
from modelgen.numeric import Array


@dataclass(frozen=True)
class Instrument:
    """Columns (M, n, p) without the errors of a record's own regressor; there (M, n): where they exist."""

    columns: Array
    there: NDArray[np.bool_]


def of_period(columns: Array, moving: NDArray[np.bool_], period: int) -> Instrument:
    """The regressor (M, n, p) at the same phase of another period of so many rows."""
    partner = other_period(len(columns), period)
    return Instrument(columns[partner], (partner >= 0)[:, None] & moving[partner])
