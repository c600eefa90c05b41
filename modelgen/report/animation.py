"""A motion for the eye: one HTML file that needs nothing beside it."""

from __future__ import annotations

import numpy as np

from modelgen.description import Arm
from modelgen.drawing import moving_page
from modelgen.numeric import Array

_FRAMES_PER_SECOND = 30
_MOST = 1800  # frames


def animation(arm: Arm, t: Array, q: Array) -> str:
    """HTML with the drawing of the arm (`modelgen.drawing`), which plays, pauses and turns.

    t: (S,) [s], q: (S, n) [rad, m]. Thirty pictures a second, at most 1,800 in all.
    """
    count = min(_MOST, max(2, round(float(t[-1] - t[0]) * _FRAMES_PER_SECOND) + 1))
    at = np.linspace(t[0], t[-1], count)
    shown = np.stack([np.interp(at, t, column) for column in q.T], axis=1)
    return moving_page(arm, at - t[0], shown)
