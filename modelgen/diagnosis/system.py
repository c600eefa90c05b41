"""The whitened equations of all training records, with what has been named so far among the columns."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lstsq

from modelgen.dataset.periods import noise_of
from modelgen.diagnosis.rows import Array, Rows
from modelgen.diagnosis.whitening import Whitener, usable_rows, whitener

LAGS = 80  # rows of autocorrelation that count
LEAST = 300  # rows from which noise is told from what repeats
EXACT = 1e-9  # of the largest residuals of a joint: what is less is taken for this
NOTHING = 1e-7  # part of a column, of unit length, that the others leave over where it depends on them


@dataclass(frozen=True)
class Gain:
    """What further columns explain. rss0, rss1: by joint, without and with; values: of the columns."""

    delta_bic: float
    values: Array
    rss0: Array
    rss1: Array
    rank: int


class System:
    """Rows of several records with columns (M, n, p) each: baseline and what was added.

    Weighted by joint, whitened, stacked joint after joint, record after record. periods: rows in a period
    of each record, None where nothing repeats.
    """

    def __init__(
        self, rows: Sequence[Rows], columns: Sequence[Array], periods: Sequence[int | None] | None = None
    ) -> None:
        self.rows = rows
        self.periods = periods or [None] * len(rows)
        self.columns = columns
        self.n = rows[0].effort.shape[1]
        self.theta = weighted_fit(rows, columns)
        self.residuals = [r.effort - c @ self.theta for r, c in zip(rows, columns, strict=True)]
        self.whiteners = [self._whitener(j) for j in range(self.n)]
        self.usable = [np.column_stack([usable_rows(r.moving[:, j]) for j in range(self.n)]) for r in rows]
        self.matrix = self.whitened(columns)
        self.right = self.whitened([r.effort[:, :, None] for r in rows])[:, 0]
        self.joint = np.concatenate(
            [np.full(int(u[:, j].sum()), j) for u in self.usable for j in range(self.n)]
        )
        self.record = np.concatenate(
            [np.full(int(u[:, j].sum()), i) for i, u in enumerate(self.usable) for j in range(self.n)]
        )
        self.plain = _Plain(self)
        self.basis = orthonormal(self.matrix)
        self.left = self.right - self.basis @ (self.basis.T @ self.right)
        self.counts = np.bincount(self.joint, minlength=self.n)
        self.rss = self.by_joint(self.left)

    def _whitener(self, j: int) -> Whitener:
        """From what differs between periods: noise alone. Else from all that is left, causes included."""
        residuals = [e[:, j] for e in self.residuals]
        moving = [r.moving[:, j] for r in self.rows]
        repeating = [k for k, p in enumerate(self.periods) if p is not None]
        if repeating:
            noise = [noise_of(residuals[k], moving[k], int(self.periods[k] or 0)) for k in repeating]
            if sum(int(flags.sum()) for _, flags in noise) > LEAST:
                return whitener([x for x, _ in noise], [flags for _, flags in noise])
        return whitener(residuals, moving)

    @property
    def noise_known(self) -> bool:
        """Whether periods repeat, by which noise is told from what the model lacks."""
        return any(p is not None for p in self.periods)

    def whitened(self, columns: Sequence[Array]) -> Array:
        """Columns (M, n, k) of each record, whitened and stacked."""
        parts = []
        for i, table in enumerate(columns):
            for j in range(self.n):
                block = np.ascontiguousarray(table[:, j, :])
                flags = self.usable[i][:, j]
                if block.any():
                    parts.append(self.whiteners[j](block, flags))
                else:
                    parts.append(np.zeros((int(flags.sum()), block.shape[1])))
        return np.concatenate(parts)

    def by_joint(self, left: Array) -> Array:
        """Sums of squares, (n,)."""
        return np.asarray(np.bincount(self.joint, weights=left**2, minlength=self.n), dtype=float)

    def gain(
        self, columns: Sequence[Array], extra: float = 0.0, positive: Sequence[bool] = ()
    ) -> Gain | None:
        """What columns (M, n, k) of each record would explain; None where they add nothing of their own.

        extra: parameters that were searched for besides. positive: (k,), columns whose value may not be
        negative; empty for none. The evidence is that of the whitened equations, or of the plain ones with
        as many of their rows as are independent, whichever is more: whitening takes slow effects for slow
        noise.
        """
        white = self.gain_of(self.whitened(columns), extra, positive)
        plain = self.plain.gain(columns, extra, positive)
        if white is None or plain is None:
            return white or plain
        return plain if plain.delta_bic > white.delta_bic else white

    def gain_of(self, stacked: Array, extra: float = 0.0, positive: Sequence[bool] = ()) -> Gain | None:
        """The same for columns that have been whitened and stacked."""
        counts = self.counts.astype(float)
        return explained(stacked, self.basis, self.left, self.by_joint, counts, extra, positive)


class _Plain:
    """The weighted equations as they are, and how many of each joint's rows are independent."""

    def __init__(self, system: System) -> None:
        self.rows = system.rows
        self.n = system.n
        self.sizes = np.array([max(_size(system, j), 1e-300) for j in range(self.n)])
        matrix = self.stacked(system.columns)
        self.joint = np.concatenate(
            [np.full(int(r.moving[:, j].sum()), j) for r in self.rows for j in range(self.n)]
        )
        self.basis = orthonormal(matrix)
        right = self.stacked([r.effort[:, :, None] for r in self.rows])[:, 0]
        self.left = right - self.basis @ (self.basis.T @ right)
        rows = np.bincount(self.joint, minlength=self.n)
        shares = np.array([_independent(system, j) for j in range(self.n)])
        self.counts = rows * shares
        self.share = float(self.counts.sum() / max(1, rows.sum()))

    def stacked(self, columns: Sequence[Array]) -> Array:
        """Moving rows, weighted, record after record, joint after joint."""
        return np.concatenate(
            [
                c[r.moving[:, j], j] / self.sizes[j]
                for r, c in zip(self.rows, columns, strict=True)
                for j in range(self.n)
            ]
        )

    def by_joint(self, left: Array) -> Array:
        """Sums of squares, (n,)."""
        return np.asarray(np.bincount(self.joint, weights=left**2, minlength=self.n), dtype=float)

    def gain(self, columns: Sequence[Array], extra: float, positive: Sequence[bool] = ()) -> Gain | None:
        """As that of the system."""
        stacked = self.stacked(columns)
        return explained(stacked, self.basis, self.left, self.by_joint, self.counts, extra, positive)


def _size(system: System, j: int) -> float:
    left = np.concatenate([e[r.moving[:, j], j] for e, r in zip(system.residuals, system.rows, strict=True)])
    return float(np.sqrt(np.mean(left**2))) if len(left) else 1.0


def _independent(system: System, j: int) -> float:
    """Share of independent rows, from what differs between periods or else from all that is left."""
    shares = []
    for e, r, p in zip(system.residuals, system.rows, system.periods, strict=True):
        values, flags = e[:, j], r.moving[:, j]
        if p is not None:
            values, flags = noise_of(values, flags, p)
        shares.append(independent(np.where(flags, values, 0.0)))
    return float(np.mean(shares))


def independent(values: Array) -> float:
    """1 / (1 + 2 sum of squared autocorrelations): of a coloured series, for variances."""
    power = float(values @ values)
    if power <= 0:
        return 1.0
    lags = [float(values[k:] @ values[:-k]) / power for k in range(1, min(LAGS, len(values) // 4))]
    return 1.0 / (1.0 + 2.0 * float(np.sum(np.square(lags))))


def explained(
    stacked: Array,
    basis: Array,
    left: Array,
    by_joint: Callable[[Array], Array],
    counts: Array,
    extra: float,
    positive: Sequence[bool] = (),
) -> Gain | None:
    """What columns explain of `left`, beyond `basis`; `counts`: rows that count, by joint.

    positive: columns whose value may not be negative: it is zero where it would be.
    """
    norms = np.linalg.norm(stacked, axis=0)
    if not norms.any() or not np.isfinite(norms).all():
        return None
    there = norms > 0
    unit = stacked[:, there] / norms[there]
    own = unit - basis @ (basis.T @ unit)
    u, s, vt = np.linalg.svd(own, full_matrices=False)
    kept = s > NOTHING
    if not kept.any():
        return None
    scores = u[:, kept].T @ left
    found, values = vt[kept].T @ (scores / s[kept]), np.zeros(len(norms))
    limited = np.flatnonzero(np.asarray(positive or [False] * len(norms))[there])
    if (found[limited] < 0).any():
        found = not_negative(s[kept, None] * vt[kept], scores, limited)
        scores = s[kept] * (vt[kept] @ found)
    values[there] = found / norms[there]
    rss0, rss1 = by_joint(left), by_joint(left - u[:, kept] @ scores)
    rank = int(kept.sum())
    used = counts > 0
    drop = (counts[used] * np.log(rss0[used] / np.maximum(rss1[used], 1e-300))).sum()
    penalty = (rank + extra) * math.log(max(2.0, float(counts.sum())))
    return Gain(float(drop - penalty), values, rss0, rss1, rank)


def not_negative(matrix: Array, right: Array, limited: NDArray[np.intp]) -> Array:
    """Least squares (k,) with the values at places `limited` not negative: the best of all active sets."""
    best, least = np.zeros(matrix.shape[1]), math.inf
    for count in range(len(limited) + 1):
        for zero in combinations(limited, count):
            free = np.setdiff1d(np.arange(matrix.shape[1]), zero)
            found = np.zeros(matrix.shape[1])
            found[free] = np.linalg.lstsq(matrix[:, free], right, rcond=NOTHING)[0]
            size = float(((right - matrix @ found) ** 2).sum())
            if (found[limited] >= 0).all() and size < least:
                best, least = found, size
    return best


def orthonormal(matrix: Array) -> Array:
    """An orthonormal basis of the columns, dependent ones left out."""
    norms = np.linalg.norm(matrix, axis=0)
    used = norms > 0
    u, s, _ = np.linalg.svd(matrix[:, used] / norms[used], full_matrices=False)
    return np.asarray(u[:, s > 1e-10 * s[0]]) if len(s) else np.zeros((len(matrix), 0))


def weighted_fit(rows: Sequence[Rows], columns: Sequence[Array]) -> Array:
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


def weights_of(rows: Sequence[Rows], columns: Sequence[Array], theta: Array) -> Array:
    """By joint (n,), of what the parameters leave."""
    left = rmse(rows, columns, theta)
    return np.asarray(1.0 / np.maximum(left, max(EXACT * float(left.max()), 1e-150)))


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


def mean_squares(system: System) -> Array:
    """Of what the fit leaves on the moving rows, by joint (n,)."""
    return rmse(system.rows, system.columns, system.theta) ** 2


def moving_share(rows: Sequence[Rows]) -> NDArray[np.float64]:
    """Share of rows that count, by joint."""
    return np.asarray(np.mean(np.concatenate([r.moving for r in rows]), axis=0))


__all__ = ["Gain", "System", "Whitener", "moving_share", "orthonormal", "rmse", "weighted_fit"]
