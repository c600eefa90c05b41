"""Parts of the records: those that are fitted, and those that the fit is tried on, then the other way round.

A part is a record, or every other one of many: a short record alone cannot hold the rest of the model.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from modelgen.diagnosis.equations import Rows
from modelgen.numeric import Array
from modelgen.regression.cross_validation import blocks, groups
from modelgen.regression.weighted import moving_rows, rmse, weighted_fit

Part = tuple[list[Rows], list[int]]  # rows, and which records they are of


@dataclass(frozen=True)
class Split:
    """most: records that are held out one by one; of more every other one is. halves: of all records, not
    record by record. within: a joint, from 0, whose equations are tried where
    the fitted rows passed as well: a law of the position tells nothing of other places.
    """

    most: int
    halves: bool = False
    within: int | None = None


def folds(rows: Sequence[Rows], split: Split) -> list[tuple[Part, Part]]:
    """Rows to fit, and rows to try that fit on."""
    found = _parts(rows, split)
    if split.within is None:
        return found
    return [((fitted, at), (_passed(tried, fitted, split.within), to)) for (fitted, at), (tried, to) in found]


def _parts(rows: Sequence[Rows], split: Split) -> list[tuple[Part, Part]]:
    every = list(range(len(rows)))
    if split.halves:
        first, second = ((part, every) for part in _masked(rows))
        return [(first, second), (second, first)]
    found = []
    for part in groups(len(rows), split.most):
        others = [i for i in every if i not in part]
        found.append((([rows[i] for i in others], others), ([rows[i] for i in part], part)))
    return found


def _passed(tried: Sequence[Rows], fitted: Sequence[Rows], j: int) -> list[Rows]:
    """Leave out tried equations of joint j at places where no fitted row was."""
    there = np.concatenate([_places(r, j)[r.moving[:, j]] for r in fitted])
    low, high = (there.min(), there.max()) if len(there) else (np.inf, -np.inf)
    found = []
    for r in tried:
        moving = r.moving.copy()
        moving[:, j] &= (_places(r, j) >= low) & (_places(r, j) <= high)
        found.append(replace(r, moving=moving))
    return found


def _places(r: Rows, j: int) -> Array:
    return np.asarray(r.prepared.q[r.prepared.rows, j])


def _masked(rows: Sequence[Rows]) -> tuple[list[Rows], list[Rows]]:
    """All records with the first half of each alone, and with the second."""
    first: list[Rows] = []
    second: list[Rows] = []
    for r in rows:
        for half, (begin, end) in zip((first, second), blocks(len(r.effort), 2), strict=True):
            flags = np.zeros(len(r.effort), dtype=bool)
            flags[begin:end] = True
            half.append(replace(r, moving=r.moving & flags[:, None]))
    return first, second


def left_unseen(rows: Sequence[Rows], columns: Sequence[Array], split: Split) -> Array:
    """Sums of squares (n,) that predictions leave of the parts that were not fitted."""
    found = np.zeros(rows[0].effort.shape[1])
    for (fitted, at), (tried, to) in folds(rows, split):
        theta = weighted_fit(fitted, [columns[i] for i in at])
        found += moving_rows(tried) * rmse(tried, [columns[i] for i in to], theta) ** 2
    return found
