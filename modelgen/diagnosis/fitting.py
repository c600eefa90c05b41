"""Least squares over the moving rows of several records, each joint weighted by what it leaves."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from scipy.linalg import lstsq

from modelgen.diagnosis.rows import Array, Rows

EXACT = 1e-9  # of the largest residuals of a joint: what is less is taken for this


def weighted_fit(rows: Sequence[Rows], columns: Sequence[Array]) -> Array:
    """Least squares over the moving rows, each joint weighted by what it leaves; two passes."""
    if not columns[0].shape[2]:
        return np.zeros(0)
    triangles = [_triangle(rows, columns, j) for j in range(rows[0].effort.shape[1])]
    weights = np.ones(len(triangles))
    for turn in range(3):
        table = np.concatenate([t * w for (t, _), w in zip(triangles, weights, strict=True)])
        norms = np.linalg.norm(table[:, :-1], axis=0)
        norms[norms == 0] = 1.0
        right = table[:, -1]
        theta = lstsq(table[:, :-1] / norms, right, cond=1e-10, lapack_driver="gelsy", check_finite=False)[0]
        theta /= norms
        if turn < 2:
            off = [np.linalg.norm(t[:, -1] - t[:, :-1] @ theta) for t, _ in triangles]
            counts = [count for _, count in triangles]
            left = np.array([o / math.sqrt(c) if c else 1.0 for o, c in zip(off, counts, strict=True)])
            weights = 1.0 / np.maximum(left, max(EXACT * float(left.max()), 1e-150))
    return np.asarray(theta)


def _triangle(rows: Sequence[Rows], columns: Sequence[Array], j: int) -> tuple[Array, int]:
    """What least squares needs of a joint's moving rows, columns and effort: R of their QR; their number."""
    moving = [r.moving[:, j] for r in rows]
    parts = [
        np.column_stack([c[m, j], r.effort[m, j]]) for r, c, m in zip(rows, columns, moving, strict=True)
    ]
    whole = np.concatenate(parts)
    return np.asarray(np.linalg.qr(whole, mode="r")), len(whole)


def stacked(
    rows: Sequence[Rows], columns: Sequence[Array], weights: Array | None = None
) -> tuple[Array, Array]:
    """Moving rows of all records and joints, weighted by joint: (R, p) and (R,)."""
    left, right = [], []
    for r, c in zip(rows, columns, strict=True):
        for j in range(r.effort.shape[1]):
            m = r.moving[:, j]
            w = 1.0 if weights is None else weights[j]
            left.append(c[m, j] * w)
            right.append(r.effort[m, j] * w)
    return np.concatenate(left), np.concatenate(right)


def rmse(rows: Sequence[Rows], columns: Sequence[Array], theta: Array) -> Array:
    """Of the moving rows, by joint (n,); nan where a joint never moves."""
    n = rows[0].effort.shape[1]
    found = np.full(n, np.nan)
    for j in range(n):
        errors = [
            (r.effort[r.moving[:, j], j] - c[r.moving[:, j], j] @ theta)
            for r, c in zip(rows, columns, strict=True)
        ]
        together = np.concatenate(errors)
        if len(together):
            found[j] = math.sqrt(float(np.mean(together**2)))
    return np.where(np.isnan(found), 1.0, found)
