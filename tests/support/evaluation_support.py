"""Shared by tests of evaluation."""

import numpy as np
from witness.arms import ARMS
from witness.mechanism import states

from modelgen.evaluation import Motion


def motion(arm: str) -> Motion:
    """A smooth motion within the strokes, 200 samples at 500 Hz."""
    q, _, _ = states(ARMS[arm], 60)
    middle, size = (q.max(axis=0) + q.min(axis=0)) / 2, (q.max(axis=0) - q.min(axis=0)) * 0.3
    t = np.arange(200) / 500
    w = 2.0 + np.arange(q.shape[1])
    phase = np.outer(t, w) + np.arange(q.shape[1])
    return Motion(t, middle + size * np.sin(phase), size * w * np.cos(phase), -size * w**2 * np.sin(phase))
