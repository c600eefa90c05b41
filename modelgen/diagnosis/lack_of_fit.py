"""What repeats from period to period is not noise: the pure-error test of lack of fit.

With k periods of the excitation, the mean residual over periods has the variance of the noise over k
where the model is complete; what it has beyond that is deterministic (Draper and Smith 1998, 1.5;
Swevers, Verdonck and De Schutter 2007 for periodic excitation). The test is made on the residuals as they
are, with the degrees of freedom that their colour leaves, and on the whitened ones.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import special

from modelgen.dataset.periods import folded
from modelgen.diagnosis.null_distribution import NULLS
from modelgen.diagnosis.rows import Array
from modelgen.diagnosis.system import System, independent

SIGNIFICANCE = 1e-3  # of a false alarm, all joints together
CLEAN = 0.99  # share of the nulls that stay below their threshold


@dataclass(frozen=True)
class LackOfFit:
    """statistic, threshold: of the joint and test that come nearest or exceed most. by_joint: (n,), plain."""

    statistic: float
    threshold: float
    by_joint: Array
    periods: int

    @property
    def found(self) -> bool:
        """Whether something deterministic is left."""
        return self.statistic > self.threshold


@dataclass
class _Sums:
    between: float = 0.0
    within: float = 0.0
    free_between: float = 0.0
    free_within: float = 0.0

    def add(self, table: Array, share: float) -> None:
        """A record of one joint, one line a period; `share` of its rows are independent."""
        there = np.isfinite(table)
        count = there.sum(axis=0)
        full = count >= 2
        if not full.any():
            return
        part, k = table[:, full], count[full]
        mean = np.nanmean(part, axis=0)
        self.between += float((k * mean**2).sum())
        self.within += float(np.nansum((part - mean) ** 2))
        self.free_between += share * float(full.sum())
        self.free_within += share * float((k - 1).sum())

    def ratio(self, taken: float, tests: int) -> tuple[float, float]:
        """F and its quantile; the fit has taken `taken` degrees of freedom from the means."""
        if self.free_within < 10 or self.within <= 0:
            return 0.0, np.inf
        free = max(5.0, self.free_between - taken)
        statistic = (self.between / free) / (self.within / self.free_within)
        return statistic, float(special.fdtri(free, self.free_within, 1 - SIGNIFICANCE / tests))


def lack_of_fit(system: System) -> LackOfFit | None:
    """Of the training records; None where nothing repeats."""
    found, most = _tests(system)
    if not any(np.isfinite(limit) for _, limit in found):
        return None
    statistic, quantile = max(found, key=lambda pair: pair[0] / pair[1])
    return LackOfFit(statistic, inflation() * quantile, np.array([s for s, _ in found[: system.n]]), most)


def inflation() -> float:
    """Of the nominal thresholds, from the calibrated null distribution."""
    return float(np.quantile(NULLS, CLEAN))


def ratios(system: System) -> list[float]:
    """Statistic over the quantile of F, of every joint's residuals as they are, then whitened (2 n,)."""
    return [statistic / quantile for statistic, quantile in _tests(system)[0]]


def _tests(system: System) -> tuple[list[tuple[float, float]], int]:
    """Statistic and quantile of F of every joint, plain, then whitened; and the most periods of a record."""
    n = system.n
    plain, white = [_Sums() for _ in range(n)], [_Sums() for _ in range(n)]
    most = 0
    for i, r in enumerate(system.rows):
        rows = system.periods[i]
        if rows is None:
            continue
        for j in range(n):
            moving = r.moving[:, j]
            residual = np.where(moving, system.residuals[i][:, j], np.nan)
            table = folded(residual, rows)
            most = max(most, -(-len(r.effort) // rows))
            plain[j].add(table, independent_rows(table))
            left = np.full(len(moving), np.nan)
            left[system.usable[i][:, j]] = system.left[(system.record == i) & (system.joint == j)]
            white[j].add(folded(left, rows), 1.0)
    taken = system.basis.shape[1] / n
    return [s.ratio(taken * share, 2 * n) for share, part in ((0.0, plain), (1.0, white)) for s in part], most


def repeating(system: System) -> Array:
    """Mean square of what repeats from period to period in the residuals of each joint (n,), less noise."""
    n = system.n
    found = np.zeros(n)
    for j in range(n):
        between, within, means, scatter = 0.0, 0.0, 0, 0
        for residual, r, rows in zip(system.residuals, system.rows, system.periods, strict=True):
            if rows is None:
                continue
            table = folded(np.where(r.moving[:, j], residual[:, j], np.nan), rows)
            count = np.isfinite(table).sum(axis=0)
            part, k = table[:, count >= 2], count[count >= 2]
            if not len(k):
                continue
            mean = np.nanmean(part, axis=0)
            between += float((k * mean**2).sum())
            within += float(np.nansum((part - mean) ** 2))
            means, scatter = means + len(k), scatter + int((k - 1).sum())
        if scatter:
            found[j] = max(0.0, (between - means * within / scatter) / (means + scatter))
    return found


def independent_rows(table: Array) -> float:
    """Share of a record's rows that count as independent, from what differs between its periods."""
    there = np.isfinite(table)
    values = np.where(there, table, 0.0)
    mean = values.sum(axis=0, keepdims=True) / np.maximum(there.sum(axis=0, keepdims=True), 1)
    return independent(np.where(there, values - mean, 0.0).ravel())
