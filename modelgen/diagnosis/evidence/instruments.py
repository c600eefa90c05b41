"""Instruments against errors of the positions: the same phase of another period.

There the regressor has the same truth and other errors, so that what the errors alone correlate in one period
is not correlated across two (Reiersoel 1945; Janot, Vandanjon and Gautier 2014 for robots).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import special
from scipy.linalg import lstsq

from modelgen.diagnosis.evidence.system import System
from modelgen.numeric import Array
from modelgen.regression.instruments import of_period


class Pairs:
    """Columns (M, n, p) of a system's records and the same in other periods, rows that move in both.

    own, other: (R, p), stacked record after record, joint after joint, over the sizes of the joints.
    """

    def __init__(self, system: System, columns: Sequence[Array]) -> None:
        rows, sizes = system.rows, system.sizes
        self.least = system.limits.min_equations_per_instrument
        self.instruments = [
            None if p is None else of_period(table, r.moving, p)
            for r, table, p in zip(rows, columns, system.periods, strict=True)
        ]
        self.flags: list[NDArray[np.bool_]] = []
        own, other, right = [], [], []
        for r, table, z in zip(rows, columns, self.instruments, strict=True):
            there = np.zeros(r.moving.shape, dtype=bool)
            if z is not None:
                there = r.moving & z.there
                for j in range(r.effort.shape[1]):
                    own.append(table[there[:, j], j] / sizes[j])
                    other.append(z.columns[there[:, j], j] / sizes[j])
                    right.append(r.effort[there[:, j], j] / sizes[j])
            self.flags.append(there)
        p = columns[0].shape[2]
        self.own = np.concatenate(own) if own else np.zeros((0, p))
        self.other = np.concatenate(other) if other else np.zeros((0, p))
        self.right = np.concatenate(right) if right else np.zeros(0)
        norms = np.linalg.norm(self.other, axis=0)
        norms[norms == 0] = 1.0
        self.scale = norms

    @property
    def enough(self) -> bool:
        """Whether there are equations enough."""
        return len(self.own) > self.least * self.own.shape[1]

    def first_stage(self) -> Array:
        """Share of the columns that those of the other period, over `scale`, explain: (p, p)."""
        found = lstsq(
            self.other / self.scale, self.own, cond=1e-10, lapack_driver="gelsy", check_finite=False
        )[0]
        return np.asarray(found)

    def t_values(self, share: float) -> Array:
        """Estimates over their standard deviations, (p,), of two-stage least squares; `share` of the rows are
        independent.
        """
        explained = (self.other / self.scale) @ self.first_stage()
        norms = np.linalg.norm(explained, axis=0)
        norms[norms == 0] = 1.0
        u, s, vt = np.linalg.svd(explained / norms, full_matrices=False)
        kept = s > 1e-8 * s[0]
        theta = vt[kept].T @ ((u[:, kept].T @ self.right) / s[kept])
        left = self.right - (self.own / norms) @ theta
        variance = float(left @ left) / len(left) / max(share, 1e-9)
        spread = np.sqrt(variance * ((vt[kept].T / s[kept]) ** 2).sum(axis=1))
        return np.asarray(theta / np.maximum(spread, 1e-300))


@dataclass(frozen=True)
class Endogeneity:
    """statistic: likelihood ratio, chi-squared of `degrees` where positions are exact; threshold: of it.

    share: percent of the whitened RMSE by joint (n,) that the errors of the regressor explain; cost: of the
    RMSE as it is, as whitening brings out what is high in frequency.
    """

    statistic: float
    degrees: int
    threshold: float
    share: Array
    cost: Array

    @property
    def found(self) -> bool:
        """Whether errors of the positions are seen."""
        return self.statistic > self.threshold


def endogeneity(system: System) -> Endogeneity | None:
    """Test the equations with all that they contain; None where nothing repeats."""
    pairs = Pairs(system, system.columns)
    if not pairs.enough:
        return None
    stage = pairs.first_stage()
    left = [
        np.zeros(table.shape)
        if z is None
        else (table - (z.columns / pairs.scale) @ stage) * there[:, :, None]
        for table, z, there in zip(system.columns, pairs.instruments, pairs.flags, strict=True)
    ]
    gain = system.white.gain(left)
    if gain is None:
        return Endogeneity(0.0, 0, np.inf, np.zeros(system.n), np.zeros(system.n))
    used = system.white.counts > 0
    ratio = gain.rss0[used] / np.maximum(gain.rss1[used], 1e-300)
    statistic = float((system.white.counts[used] * np.log(ratio)).sum())
    plain, share, cost = system.plain.gain(left), np.zeros(system.n), np.zeros(system.n)
    share[used] = 100.0 * (1.0 - 1.0 / np.sqrt(ratio))
    if plain is not None:
        used = plain.rss0 > 0
        cost[used] = 100.0 * (1.0 - np.sqrt(plain.rss1[used] / plain.rss0[used]))
    threshold = float(special.chdtri(gain.rank, system.limits.endogeneity_significance))
    return Endogeneity(statistic, gain.rank, threshold, share, cost)
