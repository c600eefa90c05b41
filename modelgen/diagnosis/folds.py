"""Parts of the records: those that are fitted, and those that the fit is tried on, then the other way round.

A part is a record, or every other one of many: a short record alone cannot hold the rest of the model.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modelgen.diagnosis.rows import Array, Rows
from modelgen.diagnosis.system import moving_rows, rmse, weighted_fit

FEW = 4  # records that are tried one by one

Part = tuple[list[Rows], list[int]]  # rows, and which records they are of


def folds(rows: Sequence[Rows], *, halves: bool) -> list[tuple[Part, Part]]:
    """Rows to fit, and rows to try that fit on."""
    every = list(range(len(rows)))
    if halves:
        first, second = ((part, every) for part in _masked(rows))
        return [(first, second), (second, first)]
    parts = [[i] for i in every] if len(rows) <= FEW else [every[k::2] for k in range(2)]
    found = []
    for part in parts:
        others = [i for i in every if i not in part]
        found.append((([rows[i] for i in others], others), ([rows[i] for i in part], part)))
    return found


def _masked(rows: Sequence[Rows]) -> tuple[list[Rows], list[Rows]]:
    """All records with the first half of each alone, and with the second."""
    first, second = [], []
    for r in rows:
        flags = np.zeros(len(r.effort), dtype=bool)
        flags[: len(flags) // 2] = True
        first.append(replace(r, moving=r.moving & flags[:, None]))
        second.append(replace(r, moving=r.moving & ~flags[:, None]))
    return first, second


def left_unseen(rows: Sequence[Rows], columns: Sequence[Array], *, halves: bool) -> Array:
    """Sums of squares (n,) that predictions leave of the parts that were not fitted."""
    found = np.zeros(rows[0].effort.shape[1])
    for (fitted, at), (tried, to) in folds(rows, halves=halves):
        theta = weighted_fit(fitted, [columns[i] for i in at])
        found += moving_rows(tried) * rmse(tried, [columns[i] for i in to], theta) ** 2
    return found
