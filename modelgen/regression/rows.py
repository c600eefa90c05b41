"""The part of a record that least squares needs."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from modelgen.numeric import Array


class MovingRows(Protocol):
    """M rows of n equations, one of each joint."""

    @property
    def effort(self) -> Array:
        """Right sides, (M, n)."""

    @property
    def moving(self) -> NDArray[np.bool_]:
        """Rows that count, (M, n): those in which the joint moves."""
