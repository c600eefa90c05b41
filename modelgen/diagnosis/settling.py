"""Parameters of an arm with elastic joints or play: what these do depends on them, and they on that."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modelgen.dataset import Prepared
from modelgen.description import Arm
from modelgen.diagnosis.baseline import Baseline
from modelgen.diagnosis.rows import Rows, rows_of
from modelgen.diagnosis.system import rmse, weighted_fit
from modelgen.functions import Model
from modelgen.numeric import Array
from modelgen.probing import Prober

HALVES = 10  # steps, of which half is taken each
WHOLES = 6  # steps by the slopes
SHORTER = 3  # times a step is halved that leads astray
TOUCH = 1e-4  # of a parameter
LEAST = 1e-7  # of its own unit


def settled(
    arm: Arm, model: Model, train: Sequence[Prepared], known: Baseline, theta: Array, rigid: float
) -> tuple[list[Rows], Array]:
    """Equations of the records at the unknowns (k,) that explain most, and these. rigid: `misfit` without the
    joints.

    At first what the joints do is held while the arm's parameters are fitted beside it, over and over. A soft
    joint answers little of these with much: where that finds nothing better than a rigid arm, Gauss's and
    Newton's steps follow, by differences.
    """
    search = _Search(Prober(arm), model, train, known)
    for _ in range(HALVES):
        rows, _ = search.at(theta)
        theta = (theta + weighted_fit(rows, [r.columns for r in rows])) / 2
    for _ in range(WHOLES if search.least >= rigid else 0):
        least, theta = search.least, search.theta
        rows = search.linearised()
        step = weighted_fit(rows, [r.columns for r in rows]) - theta
        if not any(search.at(theta + step / 2**k)[1] < least for k in range(SHORTER + 1)):
            break
    return search.rows, search.theta


def misfit(rows: Sequence[Rows], columns: Sequence[Array], theta: Array) -> float:
    """Sum over the joints of the logarithm of what the unknowns of these columns leave."""
    return float(np.log(rmse(rows, columns, theta)).sum())


class _Search:
    """Keeps the best of all unknowns that were tried."""

    def __init__(self, prober: Prober, model: Model, train: Sequence[Prepared], known: Baseline) -> None:
        self.prober, self.model, self.train, self.known = prober, model, train, known
        self.rows: list[Rows] = []
        self.theta, self.least = np.zeros(0), np.inf

    def at(self, theta: Array) -> tuple[list[Rows], float]:
        """Equations there, and their misfit."""
        rows = [rows_of(self.prober, self.model, p, theta, self.known) for p in self.train]
        left = misfit(rows, [r.columns for r in rows], theta)
        if not self.rows or left < self.least:
            self.rows, self.theta, self.least = rows, theta, left
        return rows, left

    def linearised(self) -> list[Rows]:
        """Equations at the best, with what each unknown changes for its column."""
        found = []
        for r in self.rows:
            here, columns = self.prober.inputs(r.motion, self.known.base(self.theta)), []
            for k, value in enumerate(self.theta):
                step = max(TOUCH * abs(value), LEAST)
                moved = self.theta + step * (np.arange(len(self.theta)) == k)
                columns.append((self.prober.inputs(r.motion, self.known.base(moved)) - here) / step)
            table = r.filtered(np.stack(columns, axis=2))
            found.append(replace(r, effort=r.effort + (table - r.columns) @ self.theta, columns=table))
        return found
