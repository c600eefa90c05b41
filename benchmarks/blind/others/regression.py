"""The equations of a problem as one least squares, and blocks of time to hold out.

All rows of all records and joints, each joint over what the user's model leaves of it, and with what that
model explains taken off the effort and off every column (Frisch and Waugh 1933): its parameters are fitted
beside whatever is chosen.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from blind.case import Array
from blind.others.method import Answer, Motion, Problem
from modelgen.regression.weighted import orthonormal, rmse, weighted_fit

BLOCKS = 10  # of time, in each record
OWN = 1e-6  # share of a column that the user's model must leave of it


class Regression:
    """R equations of K columns.

    target: (R,), of unit length; columns: (R, K), of unit length; joint, block: (R,), from 0; term: (K,),
    index of a column's term in the problem; place: (K,), index of a column in `Motion.table`.
    """

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        train = problem.train
        self.own = weighted_fit(train, [r.own for r in train])
        self.sizes = np.maximum(rmse(train, [r.own for r in train], self.own), 1e-300)
        parts = [(r, j) for r in train for j in range(problem.n)]
        self.joint = np.concatenate([np.full(int(r.moving[:, j].sum()), j) for r, j in parts])
        self.block = np.concatenate([blocks(len(r.moving))[r.moving[:, j]] for r, j in parts])
        basis = orthonormal(self._stacked([r.own for r in train]))
        target = self._stacked([r.effort[:, :, None] for r in train])[:, 0]
        table = self._stacked([r.table for r in train])
        left = table - basis @ (basis.T @ table)
        norms = np.linalg.norm(left, axis=0)
        self.place = np.flatnonzero(norms > OWN * np.linalg.norm(table, axis=0))
        self.columns = left[:, self.place] / norms[self.place]
        target = target - basis @ (basis.T @ target)
        self.target = target / max(float(np.linalg.norm(target)), 1e-300)
        width = [t.shape[2] for t in problem.test.terms]
        self.term = np.repeat(np.arange(len(width)), width)[self.place]

    def _stacked(self, tables: Sequence[Array]) -> Array:
        return np.concatenate(
            [
                c[r.moving[:, j], j] / self.sizes[j]
                for r, c in zip(self.problem.train, tables, strict=True)
                for j in range(self.problem.n)
            ]
        )

    def answer(self, columns: Sequence[int]) -> Answer:
        """The terms of these columns are named, and fitted beside the user's model to all training rows."""
        places = self.place[list(columns)].astype(int)
        named = frozenset(self.problem.terms[k].place for k in self.term[list(columns)].astype(int))

        def side(m: Motion) -> Array:
            return np.concatenate([m.own, m.table[:, :, places]], axis=2)

        theta = weighted_fit(self.problem.train, [side(r) for r in self.problem.train])
        return Answer(named, side(self.problem.test) @ theta)

    def compressed(self) -> list[Array]:
        """(K + 1, K + 1) for each block: as many equations with the same sums of squares, the target last."""
        every = np.column_stack([self.columns, self.target])
        return [_triangle(every[self.block == b]) for b in np.unique(self.block)]


def blocks(rows: int) -> NDArray[np.intp]:
    """Block, from 0, of each row of a record."""
    return np.arange(rows) * BLOCKS // max(rows, 1)


def without(parts: Sequence[Array], block: int) -> tuple[Array, Array]:
    """Equations (R, K), (R,) of all blocks but one."""
    every = _triangle(np.vstack([p for k, p in enumerate(parts) if k != block]))
    return every[:, :-1], every[:, -1]


def _triangle(table: Array) -> Array:
    return np.asarray(np.linalg.qr(table, mode="r"))


def held_out(parts: Sequence[Array], block: int, values: Array) -> float:
    """Sum of squares that values (K,) leave of a block."""
    return float(((parts[block][:, -1] - parts[block][:, :-1] @ values) ** 2).sum())


def sparsest(errors: Array) -> int:
    """Index of the last row of errors (choices, blocks), from rich to sparse, that is within one standard
    error of the best (Breiman, Friedman, Olshen and Stone 1984, 3.4.3).
    """
    mean = errors.mean(axis=1)
    best = int(np.argmin(mean))
    most = mean[best] + errors[best].std(ddof=1) / np.sqrt(errors.shape[1])
    return int(np.flatnonzero(mean <= most)[-1])
