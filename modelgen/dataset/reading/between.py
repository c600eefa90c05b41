"""Readings of a channel at other instants than its own."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from modelgen.dataset.processing.rounding import resolution
from modelgen.numeric import Array

# Times the time between readings of one channel, from which another has a clock of its own.
SLOWER = 1.2
_ROUNDED = 1e-5  # of a position's range, below which its rounding is no noise that splines would colour


def is_smooth(position: Array) -> bool:
    """Whether readings (N,) of a position are rounded so little that they lie on a smooth curve."""
    step = resolution(position)
    return step is None or step < _ROUNDED * float(np.ptp(position))


def between(stamps: Array, readings: Array, at: Array, *, smooth: bool) -> Array:
    """Readings (N,) at other instants (M,): by cubic splines, or by straight lines."""
    curve = CubicSpline(stamps, readings)(at) if smooth else np.interp(at, stamps, readings)
    return np.asarray(curve)
