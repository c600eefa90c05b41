"""A motion along which effects are probed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Motion:
    """N samples of one record at a uniform rate: t (N,) [s], q, dq, ddq (N, n) [rad, m and rates].

    motor_side: by coordinate, whether q was derived from a reading at the motor; empty: not known, q is taken
    as the drive's. cutoff: of the filter that regressors will pass [Hz]; 0: none.
    """

    t: Array
    q: Array
    dq: Array
    ddq: Array
    motor_side: tuple[bool, ...] = ()
    cutoff: float = 0.0

    @property
    def step(self) -> float:
        """Sampling period [s]."""
        return float(self.t[-1] - self.t[0]) / max(1, len(self.t) - 1)
