"""Least squares over the moving rows of several records, each joint weighted by its residuals."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from scipy.linalg import lstsq

from modelgen.numeric import Array
from modelgen.regression.rows import MovingRows

EXACT = 1e-9  # residuals of a joint count as at least this part of the largest ones


def weighted_fit(rows: Sequence[MovingRows], columns: Sequence[Array]) -> Array:
    """Least squares over the moving rows, each joint weighted by what it leaves; two passes."""
    n = rows[0].effort.shape[1]
    weights = np.ones(n)
    theta = np.zeros(columns[0].shape[2])
    if not len(theta):
        return theta
    for turn in range(3):
        left, right = stacked(rows, columns, weights)
        norms = np.linalg.norm(left, axis=0)
        norms[norms == 0] = 1.0
        theta = lstsq(left / norms, right, cond=1e-10, lapack_driver="gelsy", check_finite=False)[0] / norms
        if turn < 2:
            weights = weights_of(rows, columns, theta)
    return theta


def weights_of(rows: Sequence[MovingRows], columns: Sequence[Array], theta: Array) -> Array:
    """One over the RMSE that the parameters leave, by joint (n,)."""
    left = rmse(rows, columns, theta)
    return np.asarray(1.0 / np.maximum(left, max(EXACT * float(left.max()), 1e-150)))


def stacked(
    rows: Sequence[MovingRows], columns: Sequence[Array], weights: Array | None = None
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


def rmse(rows: Sequence[MovingRows], columns: Sequence[Array], theta: Array) -> Array:
    """RMSE of the moving rows by joint (n,); 1 where a joint never moves."""
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


def moving_rows(rows: Sequence[MovingRows]) -> Array:
    """How many rows count, by joint (n,)."""
    return np.asarray(np.sum([r.moving.sum(axis=0) for r in rows], axis=0))


def moving_share(rows: Sequence[MovingRows]) -> Array:
    """Share of rows that count, by joint."""
    return np.asarray(np.mean(np.concatenate([r.moving for r in rows]), axis=0))


def orthonormal(matrix: Array) -> Array:
    """An orthonormal basis of the columns, dependent ones left out."""
    norms = np.linalg.norm(matrix, axis=0)
    used = norms > 0
    u, s, _ = np.linalg.svd(matrix[:, used] / norms[used], full_matrices=False)
    return np.asarray(u[:, s > 1e-10 * s[0]]) if len(s) else np.zeros((len(matrix), 0))


def misfit(rows: Sequence[MovingRows], columns: Sequence[Array], theta: Array) -> float:
    """Sum over the joints of the logarithm of the RMSE that these parameters leave."""
    return float(np.log(rmse(rows, columns, theta)).sum())
