"""What a model leaves of the test record, before and after, with intervals from a block bootstrap.

Blocks keep the colour of the residuals (Kuensch 1989).
"""

from __future__ import annotations

import numpy as np

from modelgen.diagnosis.objects import Errors
from modelgen.diagnosis.rows import Array, Rows

DRAWS = 400
BLOCKS = 20  # in a record
SEED = 1989


def errors(rows: Rows, before: Array, after: Array, unit: str) -> Errors:
    """From residuals (M, n) in `unit`; rows that do not move do not count."""
    n = before.shape[1]
    random = np.random.default_rng(SEED)
    found = np.full((5, n), np.nan)
    for j in range(n):
        m = rows.moving[:, j]
        a, b = before[m, j] ** 2, after[m, j] ** 2
        if len(a) < BLOCKS:
            continue
        old, new = np.sqrt(a.mean()), np.sqrt(b.mean())
        parts = np.array_split(np.arange(len(a)), BLOCKS)
        sums = np.array([[a[p].sum(), b[p].sum()] for p in parts])
        drawn = sums[random.integers(BLOCKS, size=(DRAWS, BLOCKS))].sum(axis=1)
        gains = 100 * (1 - np.sqrt(drawn[:, 1] / drawn[:, 0]))
        found[:, j] = (old, new, 100 * (1 - new / old), *np.quantile(gains, [0.025, 0.975]))
    return Errors(unit, *found)
