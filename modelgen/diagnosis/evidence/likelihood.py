"""Equations of all records and joints in one scale, one after the other, and what columns explain of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import qr

from modelgen.diagnosis.equations import NominalPrior
from modelgen.diagnosis.evidence.noise import Autocorrelation
from modelgen.numeric import Array
from modelgen.regression.weighted import orthonormal

TURNS, SETTLED = 30, 0.01  # at most, of the search for a weight, and relative change that ends it
OPEN = 1e-9  # of the largest singular value: less is rounding, and records say nothing
NEGLIGIBLE = 1e-7  # part of a column, of unit length, that the others leave over where it depends on them


@dataclass(frozen=True)
class Evidence:
    """Evidence of further columns. rss0, rss1: by joint, without and with; values: of the columns."""

    delta_bic: float
    values: Array
    rss0: Array
    rss1: Array
    rank: int


class StackedEquations:
    """Residuals that a baseline leaves of R equations, and of D more that the description tells of it.

    matrix, right: (R, b), (R,), of the records alone; joint: (R,), from 0; counts, rss: (n,), how many of a
    joint's equations are independent, and sums of squares of what is left of them; share: of all rows, those
    that are independent. basis: (R + D, b), orthonormal, of the baseline; left, groups: (R + D,); weights,
    squares: (n or n + 1,), as joint, counts and rss, but with what is given as if it were one more joint.

    stacked: columns (M, n, k) of each record to (R, k); joint: (R,); columns, efforts: of each record, (M, n,
    p) and (M, n); said: of the first of the columns. alone: (R, b), as basis, of the records alone, None
    where nothing is given. colour: of the noise, None where it is white or not known.
    """

    def __init__(
        self,
        stacked: Callable[[Sequence[Array]], Array],
        joint: NDArray[np.intp],
        counts: Array,
        columns: Sequence[Array],
        efforts: Sequence[Array],
        said: NominalPrior | None = None,
        colour: Autocorrelation | None = None,
    ) -> None:
        self.records = stacked
        self.colour = colour
        self.joint = joint
        self.counts = counts
        self.matrix = stacked(columns)
        self.right = stacked([effort[:, :, None] for effort in efforts])[:, 0]
        self.share = float(counts.sum() / max(1, len(joint)))
        matrix, right, self.groups, self.weights = self.matrix, self.right, joint, counts
        self.alone: Array | None = None
        if said is not None and self.share > 0:
            self.alone = orthonormal(matrix)
            rows = np.zeros((len(said.rows), matrix.shape[1]))
            rows[:, : said.rows.shape[1]] = said.rows
            belief = believed(matrix, right, replace(said, rows=rows), self.share)
            # one equation more, which nothing changes: the scatter that is expected
            rows = np.vstack([rows, np.zeros(matrix.shape[1])]) * belief.weight
            further = np.append(said.right, math.sqrt(belief.faith)) * belief.weight
            matrix, right = np.vstack([matrix, rows]), np.append(right, further)
            self.groups = np.append(joint, np.full(len(rows), len(counts)))
            self.weights = np.append(counts, belief.count + belief.faith)
        self.basis = orthonormal(matrix)
        self.left = right - self.basis @ (self.basis.T @ right)
        self.squares = self.by_group(self.left)
        self.rss = self.squares[: len(counts)]

    def stacked(self, columns: Sequence[Array]) -> Array:
        """Columns (M, n, k) of each record, of which nothing is given: (R + D, k)."""
        found = self.records(columns)
        return np.vstack([found, np.zeros((len(self.groups) - len(found), found.shape[1]))])

    def shown(self, unit: Array) -> NDArray[np.bool_]:
        """Flags (k,) of stacked columns (R + D, k) of unit length of which the records show something, beside
        the baseline and each other: what they cannot show is none, whatever the description says.
        """
        basis = self.basis if self.alone is None else self.alone
        return independent_of(unit[: len(basis)], basis)

    @cached_property
    def products(self) -> list[tuple[Array, Array]]:
        """Of each group, as `squares`: the basis' rows there with themselves (b, b), and with `left` (b,)."""
        parts = [self.groups == j for j in range(len(self.weights))]
        return [(self.basis[p].T @ self.basis[p], self.basis[p].T @ self.left[p]) for p in parts]

    def by_group(self, left: Array) -> Array:
        """Sums of squares of (R + D,), as `squares`."""
        found = np.bincount(self.groups, weights=left**2, minlength=len(self.weights))
        return np.asarray(found, dtype=float)

    def gain(
        self,
        columns: Sequence[Array],
        extra: float = 0.0,
        positive: Sequence[bool] = (),
        *,
        passing: bool = False,
    ) -> Evidence | None:
        """Evidence of columns (M, n, k) of each record; None where they add nothing of their own.

        extra: parameters that were searched for besides. positive: (k,), columns whose value may not be
        negative; empty for none. passing: they do not
        repeat with the periods, and their part in what differs between these is not noise.
        """
        return explained(self.stacked(columns), self, extra, positive, passing=passing)


@dataclass(frozen=True)
class Belief:
    """Belief in what is given beside some equations. weight: one over its scatter among them; count: of it,
    what the records could contradict; faith: measurements that the scatter expected is worth.
    """

    weight: float
    count: float
    faith: float


def believed(matrix: Array, right: Array, said: NominalPrior, share: float) -> Belief:
    """Find the belief in what is given beside equations (R, b), (R,), of which `share` are independent.
    said: of all b columns.

    The likeliest scatter, begun with the records alone: what contradicts them has no say. What the records
    leave open agrees with all that is given, and says nothing about its scatter.
    """
    rows, further = said.rows, said.right
    norms = np.linalg.norm(np.vstack([matrix, rows]), axis=0)
    norms[norms == 0] = 1.0
    q, r = np.linalg.qr(matrix / norms)
    told, right = rows / norms, q.T @ right
    _, s, vt = np.linalg.svd(r)
    sizes = np.full(len(vt), OPEN * s.max(initial=1e-300))
    sizes[: len(s)] = np.maximum(s, sizes[0])
    # of what is told, in independent combinations, as the records alone have it
    variances = np.linalg.svd((told @ vt.T) / sizes, compute_uv=False) ** 2 / share
    scatter = math.inf
    for _ in range(TURNS):
        weight = 0.0 if math.isinf(scatter) else 1.0 / math.sqrt(scatter * share)
        table = np.vstack([r, weight * told])
        found = np.linalg.lstsq(table, np.append(right, weight * further), rcond=NEGLIGIBLE)[0]
        size = 1.0 if math.isinf(scatter) else scatter
        count = float((size / (size + variances)).sum())
        faith = max(said.least, count)
        before, scatter = scatter, (float(((further - told @ found) ** 2).sum()) + faith) / (count + faith)
        if abs(scatter - before) < SETTLED * scatter:
            break
    return Belief(1.0 / math.sqrt(scatter * share), count, faith)


def weighted(columns: Sequence[Array], moving: Sequence[NDArray[np.bool_]], sizes: Array) -> Array:
    """Columns (M, n, k) of each record over the sizes (n,) of its joints, stacked. moving: (M, n) of each."""
    return np.concatenate(
        [
            table[flags[:, j], j] / sizes[j]
            for table, flags in zip(columns, moving, strict=True)
            for j in range(len(sizes))
        ]
    )


def joints_of(flags: Sequence[NDArray[np.bool_]]) -> NDArray[np.intp]:
    """Joint, from 0, of each stacked row. flags: (M, n) of every record."""
    return np.concatenate([np.full(int(f[:, j].sum()), j) for f in flags for j in range(f.shape[1])])


def explained(
    stacked: Array,
    stack: StackedEquations,
    extra: float = 0.0,
    positive: Sequence[bool] = (),
    *,
    passing: bool = False,
) -> Evidence | None:
    """Evidence of columns (R + D, k) in what the stack's baseline leaves.

    positive: columns whose value may not be negative: it is zero where it would be. passing: as of
    `StackedEquations.gain`.
    """
    basis, left, n = stack.basis, stack.left, len(stack.counts)
    norms = np.linalg.norm(stacked, axis=0)
    if not norms.any() or not np.isfinite(norms).all():
        return None
    there = norms > 0
    unit = stacked[:, there] / norms[there]
    shown = stack.shown(unit)
    there[there] = shown
    if not there.any():
        return None
    unit = unit[:, shown]
    own = unit - basis @ (basis.T @ unit)
    u, s, vt = np.linalg.svd(own, full_matrices=False)
    kept = s > NEGLIGIBLE
    scores = u[:, kept].T @ left
    found, values = vt[kept].T @ (scores / s[kept]), np.zeros(len(norms))
    limited = np.flatnonzero(np.asarray(positive or [False] * len(norms))[there])
    if (found[limited] < 0).any():
        found = not_negative(s[kept, None] * vt[kept], scores, limited)
        scores = s[kept] * (vt[kept] @ found)
    values[there] = found / norms[there]
    after = left - u[:, kept] @ scores
    rss0, rss1 = stack.squares, stack.by_group(after)
    rank = int(kept.sum())
    used, weights = stack.weights > 0, stack.weights.copy()
    if stack.colour is not None:
        colour = stack.colour.of(after) if passing else stack.colour
        weights[:n] *= _unhidden(u[:, kept], scores, stack, colour, passing=passing)
    drop = (weights[used] * np.log(rss0[used] / np.maximum(rss1[used], 1e-300))).sum()
    penalty = (rank + extra) * math.log(max(2.0, float(stack.counts.sum())))
    return Evidence(float(drop - penalty), values, rss0[:n], rss1[:n], rank)


def independent_of(columns: Array, basis: Array) -> NDArray[np.bool_]:
    """Flags (k,) of columns (R, k) of unit length that show something of their own beside an orthonormal
    basis (R, b), and beside each other. Of those that depend on each other the clearest have it.
    """
    own = columns - basis @ (basis.T @ columns)
    r, order = qr(own, mode="r", pivoting=True)
    sizes = np.abs(np.diagonal(r))
    found = np.zeros(columns.shape[1], dtype=bool)
    found[order[: len(sizes)]] = sizes > NEGLIGIBLE
    return found


def _unhidden(
    basis: Array, scores: Array, stack: StackedEquations, colour: Autocorrelation, *, passing: bool
) -> float:
    """Share of the evidence of scores (k,) along orthonormal columns (R + D, k) that noise of this colour
    leaves: as many rows are independent as the variance of the scores says, and not more than for variances,
    or, where what passes was a part of the noise by which those were counted, than there are.
    """
    count = len(stack.joint)
    rows = np.bincount(stack.joint, minlength=len(stack.counts))
    share = np.append(stack.counts / np.maximum(rows, 1), stack.share)[stack.groups]
    variance = colour.variance(basis[:count]) + basis[count:].T @ basis[count:] / stack.share
    sizes, vectors = np.linalg.eigh(variance)
    squares = (vectors.T @ scores) ** 2
    counted = share @ (basis @ vectors) ** 2
    most = np.ones(len(sizes)) if passing else counted
    known = np.minimum(most, 1.0 / np.maximum(sizes, 1e-300))
    return float(known @ squares / max(float(counted @ squares), 1e-300))


def not_negative(matrix: Array, right: Array, limited: NDArray[np.intp]) -> Array:
    """Least squares (k,) with the values at places `limited` not negative: the best of all active sets."""
    best, least = np.zeros(matrix.shape[1]), math.inf
    for count in range(len(limited) + 1):
        for zero in combinations(limited, count):
            free = np.setdiff1d(np.arange(matrix.shape[1]), zero)
            found = np.zeros(matrix.shape[1])
            found[free] = np.linalg.lstsq(matrix[:, free], right, rcond=NEGLIGIBLE)[0]
            size = float(((right - matrix @ found) ** 2).sum())
            if (found[limited] >= 0).all() and size < least:
                best, least = found, size
    return best
