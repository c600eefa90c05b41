"""How far two results are apart."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike


def worst(ours: ArrayLike, theirs: ArrayLike) -> float:
    """Largest deviation of a sample (first axis) from the witness's, relative to the norm of the latter.

    A sample whose result happens to be tiny beside the others counts as a millionth of the largest.
    """
    a, b = np.asarray(ours, dtype=float), np.asarray(theirs, dtype=float)
    assert a.shape == b.shape, f"{a.shape} against {b.shape}"
    assert np.isfinite(a).all()
    assert np.isfinite(b).all()
    a, b = a.reshape(len(a), -1), b.reshape(len(b), -1)
    norms = np.linalg.norm(b, axis=1)
    scale = np.maximum(norms, 1e-6 * norms.max(initial=0.0))
    gaps = np.linalg.norm(a - b, axis=1)
    return float(np.max(gaps / np.where(scale > 0, scale, 1.0), initial=0.0))


def agree(ours: ArrayLike, theirs: ArrayLike, tolerance: float = 1e-10) -> None:
    """Fail where the deviation exceeds `tolerance`."""
    deviation = worst(ours, theirs)
    assert deviation <= tolerance, f"deviation {deviation:.3g}, tolerance {tolerance:g}"
