"""Residuals made white: an autoregressive model by joint, estimated from runs of moving rows.

With coloured residuals, differences of fit are overstated many times; the same filter on both sides of
the equations undoes that (generalised least squares; Ljung 1999, chapter 16).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from modelgen.numeric import Array

ORDER = 12


@dataclass(frozen=True)
class Whitener:
    """Of one joint: the prediction-error filter 1 - a1 z^-1 - ... and the size of what it leaves."""

    taps: Array
    size: float

    def __call__(self, values: Array, usable: NDArray[np.bool_]) -> Array:
        """(M, k) filtered and scaled to unit size, of the usable rows alone."""
        return np.asarray(lfilter(self.taps, 1.0, values, axis=0)[usable] / self.size)


def whitened(
    columns: Sequence[Array], usable: Sequence[NDArray[np.bool_]], whiteners: Sequence[Whitener]
) -> Array:
    """Columns (M, n, k) of each record, whitened by joint and stacked. usable: (M, n) of each record."""
    parts = []
    for table, flags in zip(columns, usable, strict=True):
        for j, white in enumerate(whiteners):
            block, rows = np.ascontiguousarray(table[:, j, :]), flags[:, j]
            parts.append(white(block, rows) if block.any() else np.zeros((rows.sum(), block.shape[1])))
    return np.concatenate(parts)


def all_usable(moving: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """`usable_rows` of every joint, (M, n)."""
    return np.column_stack([usable_rows(flags) for flags in moving.T])


def usable_rows(moving: NDArray[np.bool_], order: int = ORDER) -> NDArray[np.bool_]:
    """Rows (M,) that have `order` moving rows before them."""
    run = np.zeros(len(moving), dtype=int)
    count = 0
    for i, flag in enumerate(moving):
        count = count + 1 if flag else 0
        run[i] = count
    return np.asarray(run > order)


def whitener(residuals: Sequence[Array], moving: Sequence[NDArray[np.bool_]], order: int = ORDER) -> Whitener:
    """From the residuals (M,) of one joint in all records, by least squares over the runs."""
    past, now = [], []
    for residual, flags in zip(residuals, moving, strict=True):
        usable = np.flatnonzero(usable_rows(flags, order))
        past.append(np.column_stack([residual[usable - lag] for lag in range(1, order + 1)]))
        now.append(residual[usable])
    x, y = np.concatenate(past), np.concatenate(now)
    if len(y) < 4 * order:
        left = np.concatenate([r[m] for r, m in zip(residuals, moving, strict=True)])
        size = float(np.sqrt(np.mean(left**2))) if len(left) else 1.0
        return Whitener(np.concatenate([[1.0], np.zeros(order)]), max(size, 1e-300))
    a = np.linalg.lstsq(x, y, rcond=None)[0]
    left = y - x @ a
    return Whitener(np.concatenate([[1.0], -a]), max(float(np.sqrt(np.mean(left**2))), 1e-300))
