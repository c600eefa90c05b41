"""What a model leaves of the test record, before and after, with intervals from a block bootstrap.

Blocks keep the colour of the residuals (Kuensch 1989).
"""

from __future__ import annotations

import numpy as np

from modelgen.dataset import Record
from modelgen.diagnosis.objects import Errors
from modelgen.diagnosis.rows import Rows
from modelgen.numeric import Array
from modelgen.simulation.windows import Windows

DRAWS = 400
BLOCKS = 20  # in a record
SEED = 1989


def errors(rows: Rows, before: Array, after: Array, unit: str) -> Errors:
    """From residuals (M, n) in `unit`; rows that do not move do not count."""
    n = before.shape[1]
    found = [compared(before[rows.moving[:, j], j], after[rows.moving[:, j], j]) for j in range(n)]
    return Errors(unit, *np.array(found).T)


def motion_errors(record: Record, before: Windows | None, after: Windows | None) -> Errors:
    """Of the simulated positions of a free motion [rad, m]; not a number where one cannot be simulated."""
    n = record.n
    found = np.full((n, 5), np.nan)
    joints = [] if record.arm is None else [record.arm.joints[i] for i in record.arm.coordinates]
    unit = ", ".join(dict.fromkeys("m" if j.type == "prismatic" else "rad" for j in joints)) or "rad"
    if before is not None and after is not None and before.simulated.shape == after.simulated.shape:
        old, new = ((s.simulated - s.measured).reshape(-1, n) for s in (before, after))
        found = np.array([compared(old[:, j], new[:, j]) for j in range(n)])
    return Errors(unit, *found.T)


def compared(before: Array, after: Array) -> tuple[float, ...]:
    """RMSE before and after, gain in percent and its interval, from errors (M,) in order of time."""
    if len(before) < BLOCKS:
        return (np.nan,) * 5
    random = np.random.default_rng(SEED)
    a, b = before**2, after**2
    old, new = np.sqrt(a.mean()), np.sqrt(b.mean())
    parts = np.array_split(np.arange(len(a)), BLOCKS)
    sums = np.array([[a[p].sum(), b[p].sum()] for p in parts])
    drawn = sums[random.integers(BLOCKS, size=(DRAWS, BLOCKS))].sum(axis=1)
    gains = 100 * (1 - np.sqrt(drawn[:, 1] / drawn[:, 0]))
    low, high = np.quantile(gains, [0.025, 0.975])
    return float(old), float(new), float(100 * (1 - new / old)), float(low), float(high)
