"""Linear regression of stacked rows: weights by joint, robust weights, autocorrelated residuals."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lapack, qr, solve_triangular

from modelgen.numeric import Array
from modelgen.regression.autocovariance import sandwich

DEPENDENT = 1e-8  # part of a column, of unit length, that the others leave over where it depends on them
HUBER = 1.345  # 95 % efficient for normal residuals (Huber 1981)
ROUNDS = 20
LEAST = 1e-3  # eigenvalue of the correlation between joints
PANEL = 4  # columns that LAPACK's dtpqrt takes together: the fastest for the tens of columns of an arm


class Triangle:
    """Rows (M, p) and right sides (M,) added block by block, kept as one triangle (p + 1, p + 1).

    Sequential blocked QR (Demmel, Grigori, Hoemmen and Langou 2012): memory does not grow with the rows.
    """

    def __init__(self, columns: int) -> None:
        self.r: Array = np.zeros((columns + 1, columns + 1), order="F")
        self.count = 0

    def add(self, matrix: Array, right: Array) -> None:
        """Take in further rows."""
        block = np.empty((len(right), len(self.r)), order="F")
        block[:, :-1], block[:, -1] = matrix, right
        self.count += len(right)
        self.r, *_, info = lapack.dtpqrt(
            0, min(PANEL, len(self.r)), self.r, block, overwrite_a=1, overwrite_b=1
        )
        assert info == 0

    def solve(self) -> tuple[Array, NDArray[np.bool_], float]:
        """Parameters (p,), flags of those that the rows determine (p,), condition number.

        Undetermined parameters are zero; the condition is of the determined columns at unit length. Raises
        FloatingPointError where a row is not finite.
        """
        if not np.isfinite(self.r).all():
            raise FloatingPointError("a row is not finite")
        matrix, right = self.r[:, :-1], self.r[:, -1]
        size = np.linalg.norm(matrix, axis=0)
        scale = np.where(size > 0, size, 1.0)
        q, r, order = qr(matrix / scale, mode="economic", pivoting=True)
        rank = int(np.sum(np.abs(np.diag(r)) > DEPENDENT))
        theta, known = np.zeros(matrix.shape[1]), np.zeros(matrix.shape[1], dtype=bool)
        if not rank:
            return theta, known, 1.0
        theta[order[:rank]] = solve_triangular(r[:rank, :rank], (q.T @ right)[:rank])
        known[order[:rank]] = True
        return theta / scale, known, float(np.linalg.cond(r[:rank, :rank]))


@dataclass(frozen=True)
class Solution:
    """theta: (p,); covariance: (p, p), zero for what is not determined; determined: (p,); condition: of
    the weighted columns at unit length; sigma: (n,) residuals' size by joint; precision: (p, p), normal
    matrix of the weighted rows. left_out: (p,), what was removed from the fit, None: nothing.
    """

    theta: Array
    covariance: Array
    determined: NDArray[np.bool_]
    condition: float
    sigma: Array
    precision: Array
    left_out: NDArray[np.bool_] | None = None

    @property
    def dropped(self) -> NDArray[np.bool_]:
        """Flags (p,) of what was removed from the fit."""
        return np.zeros(len(self.theta), dtype=bool) if self.left_out is None else self.left_out

    @property
    def kept(self) -> NDArray[np.bool_]:
        """Flags (p,) of what was found from the rows."""
        return self.determined & ~self.dropped

    def uncertain_by(self, moves: Sequence[Array]) -> Solution:
        """The solution with covariance for what moves the kept parameters by each of `moves` (kept,) at once,
        all by one error that nobody knows the size and the sign of.
        """
        covariance = self.covariance.copy()
        for moved in moves:
            covariance[np.ix_(self.kept, self.kept)] += np.outer(moved, moved)
        return replace(self, covariance=covariance)


@dataclass(frozen=True)
class Regression:
    """Rows of several records. effort: (M, n) each; columns: (M, n, p); moving: (M, n), rows that count.

    white: (lags,) autocorrelation that white noise of the samples has in the rows; None: not known.
    """

    effort: Sequence[Array]
    columns: Sequence[Array]
    moving: Sequence[NDArray[np.bool_]]
    white: Array | None = None

    def solve(self, method: str = "wls") -> Solution:
        """By "ols", "wls" (weights from the residuals of each joint), "robust" (Huber's on top), or "gls".

        "gls" also takes the covariance of the residuals between the joints at one time into account (Zellner
        1962): joints that share a motor share its noise.
        """
        if method == "gls":
            return self._with_covariance()
        n = self.effort[0].shape[1]
        weights = [m.astype(float) for m in self.moving]
        theta, known, condition = self._fit(weights)
        sigma = self._sigma(theta)
        for _ in range(0 if method == "ols" else ROUNDS):
            weights = [m / sigma for m in self.moving]
            if method == "robust":
                weights = [w * _huber(e * w) for w, e in zip(weights, self.residuals(theta), strict=True)]
            before = theta
            theta, known, condition = self._fit(weights)
            sigma = self._sigma(theta, robust=method == "robust")
            if np.allclose(theta, before, rtol=1e-9, atol=1e-12):
                break
        assert len(sigma) == n
        covariance = self._covariance(theta, known, weights)
        return Solution(theta, covariance, known, condition, sigma, self._precision(sigma))

    def beside(self, added: Sequence[Array]) -> Regression:
        """The rows with further columns (M, n, k) of each record after their own."""
        both = zip(self.columns, added, strict=True)
        return replace(self, columns=[np.concatenate([own, more], axis=2) for own, more in both])

    def as_in(self, solution: Solution) -> Regression:
        """The rows with the weights and the columns of a solution's fit, for `least_squares`."""
        weights = 1.0 / np.maximum(solution.sigma, 1e-300)
        columns = [c[:, :, solution.kept] * weights[:, None] for c in self.columns]
        return replace(self, effort=[e * weights for e in self.effort], columns=columns)

    def moved_by(self, solution: Solution, errors: Sequence[Array]) -> Array:
        """What errors of the efforts, (M, n) of each record, move the kept parameters of a solution by."""
        return replace(self, effort=errors).as_in(solution).least_squares()

    def least_squares(self) -> Array:
        """Parameters (p,) by "ols" alone, for whoever does not ask how certain they are."""
        return self._fit([m.astype(float) for m in self.moving])[0]

    def _with_covariance(self) -> Solution:
        solution = self.solve("wls")
        for _ in range(ROUNDS):
            before = solution.theta
            white = self.whitened(self.between(before))
            solution = white.solve("ols")
            if np.allclose(solution.theta, before, rtol=1e-6, atol=1e-12):
                break
        ones = np.ones(self.effort[0].shape[1])
        return replace(solution, sigma=self._sigma(solution.theta), precision=white._precision(ones))

    def between(self, theta: Array) -> Array:
        """Covariance (n, n) of the residuals between joints, over the rows where both move."""
        left = np.concatenate([e * m for e, m in zip(self.residuals(theta), self.moving, strict=True)])
        there = np.concatenate(self.moving).astype(float)
        sigma = self._sigma(theta)
        correlation = (left.T @ left) / np.maximum(there.T @ there, 1.0) / np.outer(sigma, sigma)
        np.fill_diagonal(correlation, 1.0)
        # Each element has rows of its own: together they may not be a covariance.
        values, vectors = np.linalg.eigh(correlation)
        correlation = (vectors * np.maximum(values, LEAST)) @ vectors.T
        return np.asarray(correlation * np.outer(sigma, sigma))

    def whitened(self, covariance: Array) -> Regression:
        """Rows whose residuals do not hang together between joints; rows that do not count are zero."""
        efforts, columns = [], []
        for y, table, moving in zip(self.effort, self.columns, self.moving, strict=True):
            effort, column = np.zeros_like(y), np.zeros_like(table)
            patterns, which = np.unique(moving, axis=0, return_inverse=True)
            for k, pattern in enumerate(patterns):
                own = np.flatnonzero(pattern)
                rows = np.flatnonzero(which.ravel() == k)
                lower = np.linalg.inv(np.linalg.cholesky(covariance[np.ix_(own, own)]))
                effort[np.ix_(rows, own)] = y[np.ix_(rows, own)] @ lower.T
                column[np.ix_(rows, own)] = np.einsum("ij,mjp->mip", lower, table[np.ix_(rows, own)])
            efforts.append(effort)
            columns.append(column)
        return Regression(efforts, columns, self.moving)

    def residuals(self, theta: Array) -> list[Array]:
        """Effort minus prediction, (M, n) of each record."""
        return [y - w @ theta for y, w in zip(self.effort, self.columns, strict=True)]

    def _fit(self, weights: Sequence[Array]) -> tuple[Array, NDArray[np.bool_], float]:
        triangle = Triangle(self.columns[0].shape[2])
        for y, table, w in zip(self.effort, self.columns, weights, strict=True):
            for j in range(y.shape[1]):
                rows = w[:, j] > 0
                if rows.any():
                    triangle.add(table[rows, j] * w[rows, j, None], y[rows, j] * w[rows, j])
        return triangle.solve()

    def _sigma(self, theta: Array, *, robust: bool = False) -> Array:
        left = self.residuals(theta)
        found = []
        for j in range(self.effort[0].shape[1]):
            e = np.concatenate([r[m[:, j], j] for r, m in zip(left, self.moving, strict=True)])
            size = 0.0
            if len(e):
                size = 1.4826 * np.median(np.abs(e)) if robust else np.sqrt(np.mean(e**2))
            found.append(float(size) or 1.0)
        return np.array(found)

    def _precision(self, sigma: Array) -> Array:
        """Normal matrix of the rows by joint over its residuals' variance."""
        total = np.zeros((self.columns[0].shape[2],) * 2)
        for table, m in zip(self.columns, self.moving, strict=True):
            for j, size in enumerate(sigma):
                rows = table[m[:, j], j] / size
                total += rows.T @ rows
        return total

    def _covariance(self, theta: Array, known: NDArray[np.bool_], weights: Sequence[Array]) -> Array:
        result = np.zeros((len(known), len(known)))
        columns = [c[:, :, known] for c in self.columns]
        result[np.ix_(known, known)] = sandwich(columns, self.residuals(theta), weights, self.white)
        return result


def _huber(e: Array) -> Array:
    """Square roots of Huber's weights of residuals of unit size."""
    return np.asarray(np.sqrt(np.minimum(1.0, HUBER / np.maximum(np.abs(e), 1e-300))))
