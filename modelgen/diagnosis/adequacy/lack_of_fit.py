"""What repeats from period to period is not noise: the pure-error test of lack of fit.

With k periods of the excitation, the mean residual over periods has the variance of the noise over k
where the model is complete; what it has beyond that is deterministic (Draper and Smith 1998, 1.5;
Swevers, Verdonck and De Schutter 2007 for periodic excitation). The test is made on the residuals as they
are, with the degrees of freedom that their colour leaves, over all rows and over short parts of the period,
where a contact or a hard spot shows. Whitened residuals would show errors of the encoders, which repeat with
the motion and are large at high frequencies alone. Counts that round the same motion alike in every period
repeat too: what they are expected to leave is no lack of fit.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property

import numpy as np
from scipy import special

from modelgen.dataset.processing.periods import by_phase, folded
from modelgen.diagnosis.adequacy.null_distribution import NULLS
from modelgen.diagnosis.adequacy.scatter import Phases, Scatter, parts
from modelgen.diagnosis.equations import Rows
from modelgen.diagnosis.evidence import System, independent
from modelgen.diagnosis.options.thresholds import AdequacyThresholds, EvidenceThresholds
from modelgen.numeric import Array

WHOLE, PART = "whole", "part"


@dataclass(frozen=True)
class Test:
    """Statistic and quantile of F. kind: WHOLE or PART; joint from 0; inflation: of what the quantile has
    above one, as complete models have it.

    record, begin, end: of a part, its record and its phases in rows of the period.
    """

    kind: str
    joint: int
    statistic: float
    quantile: float
    inflation: float
    record: int = -1
    begin: int = 0
    end: int = 0

    @property
    def threshold(self) -> float:
        """The quantile, with what it has above one scaled to what complete models reach."""
        return 1.0 + self.inflation * (self.quantile - 1.0)

    @property
    def beyond(self) -> float:
        """Excess of the statistic over one in units of its quantile's, whatever the records' length."""
        return (self.statistic - 1.0) / (self.quantile - 1.0)

    @property
    def found(self) -> bool:
        """Whether something deterministic is left."""
        return self.statistic > self.threshold


@dataclass(frozen=True)
class LackOfFit:
    """statistic, threshold: of the test that comes nearest or exceeds most. tests: of all rows and parts."""

    worst: Test
    tests: Sequence[Test]
    periods: int

    @property
    def by_joint(self) -> Array:
        """Statistics (n,) of all rows of each joint."""
        return np.array([t.statistic for t in self.tests if t.kind == WHOLE])

    def usual(self, joints: Sequence[int], share: float) -> bool:
        """Whether as little is left at these joints as at those of a share of complete models."""
        most = {kind: float(np.quantile(NULLS[kind], share)) for kind in (WHOLE, PART)}
        return all(t.beyond < most[t.kind] for t in self.tests if t.joint in joints)

    @property
    def statistic(self) -> float:
        """Of the worst test."""
        return self.worst.statistic

    @property
    def threshold(self) -> float:
        """Of the worst test."""
        return self.worst.threshold

    @property
    def found(self) -> bool:
        """Whether something deterministic is left."""
        return self.worst.found


@dataclass
class _Sums:
    """Sums of one joint by record and phase. limits: by which is tested."""

    limits: AdequacyThresholds
    phases: list[Phases] = field(default_factory=list)

    def add(self, record: int, table: Array, share: float, errors: Array) -> None:
        """A record of one joint, one line a period; `share` of its rows are independent. errors: the same
        of what rounded readings leave alike in every period.
        """
        between, within, k = by_phase(table)
        full = k > 0
        if not full.any():
            return
        rounding = np.where(np.isfinite(table) & full, errors**2, 0.0).sum(axis=0)
        free = np.where(full, share, 0.0), share * np.maximum(k - 1, 0)
        self.phases.append(Phases(record, between, within, *free, rounding))

    @property
    def free_between(self) -> float:
        """Independent phases of all records."""
        return sum(float(one.free_between.sum()) for one in self.phases)

    @property
    def free_within(self) -> float:
        """Degrees of freedom of what differs between the periods of a record."""
        return sum(float(one.free_within.sum()) for one in self.phases)

    @property
    def within(self) -> float:
        """Squares of that."""
        return sum(float(one.within.sum()) for one in self.phases)

    @cached_property
    def scatter(self) -> Scatter:
        """Noise by record and phase."""
        return Scatter(self.phases, self.limits.lack_of_fit_significance, self.limits.parts_of_period)

    @property
    def repeated(self) -> float:
        """Mean square that rounding is expected to leave between periods, for each independent phase."""
        return sum(float(one.rounding.sum()) for one in self.phases) / self.free_between

    def whole(self, joint: int, tests: int) -> Test:
        """Test all rows."""
        size = inflation(WHOLE, self.limits.null_share)
        if self.free_within < self.limits.min_scatter_rows or self.within <= 0:
            return Test(WHOLE, joint, 0.0, np.inf, size)
        free = max(self.limits.min_phase_rows, self.free_between)
        between = sum(float(one.between.sum()) for one in self.phases)
        statistic = (between / free) / (self.within / self.free_within + self.repeated)
        noise = self.scatter.everywhere()
        quantile = self._quantile(max(self.limits.min_phase_rows, noise.between), noise.within, tests)
        return Test(WHOLE, joint, statistic, quantile, size)

    def parts(self, joint: int, tests: int) -> Iterator[Test]:
        """Test every part of every record.

        Where residuals scatter clearly more than elsewhere, by outliers or by noise that grows, that is the
        measure: the mean over periods has its share of it. Nor is rounding alike everywhere.
        """
        limits, size = self.limits, inflation(PART, self.limits.null_share)
        if self.free_within < limits.min_scatter_rows or self.within <= 0:
            return
        tests *= 2 * limits.parts_of_period * len(self.phases)
        repeated = self.repeated
        for k, one in enumerate(self.phases):
            rows = len(one.between)
            for begin, end in parts(rows, limits.parts_of_period):
                phases = np.arange(begin, end) % rows
                count = float(one.free_between[phases].sum())
                if count < limits.min_part_rows:
                    continue
                noise = self.scatter.at(k, phases)
                rounding = max(repeated, float(one.rounding[phases].sum()) / count)
                statistic = float(one.between[phases].sum()) / count / (noise.square + rounding)
                quantile = self._quantile(noise.between, noise.within, tests)
                yield Test(PART, joint, statistic, quantile, size, one.record, begin, end)

    def _quantile(self, between: float, within: float, tests: int) -> float:
        return float(special.fdtri(between, within, 1 - self.limits.lack_of_fit_significance / tests))


def lack_of_fit(system: System) -> LackOfFit | None:
    """Test the training records; None where nothing repeats."""
    found, most = _tests(system)
    if not any(np.isfinite(t.quantile) for t in found):
        return None
    worst = max(found, key=lambda t: t.statistic / t.threshold)
    return LackOfFit(worst, found, most)


def place(fit: LackOfFit, rows: Sequence[Rows]) -> tuple[str, float, float] | None:
    """Record, and times from and to in its first period [s], of the part that shows most; None where it is no
    part.
    """
    worst = fit.worst
    if worst.kind != PART:
        return None
    p = rows[worst.record].prepared
    time = p.picked(p.time)
    return p.record.name, float(time[worst.begin]), float(time[min(worst.end, len(time) - 1)])


@cache
def inflation(kind: str, share: float) -> float:
    """Factor on what the nominal thresholds have above one: `share` of complete models stay below."""
    return float(np.quantile(NULLS[kind], share))


def ratios(system: System) -> dict[str, float]:
    """Largest excess of a statistic over one, in units of its quantile's excess, by kind of test."""
    found, _ = _tests(system)
    return {k: max((t.beyond for t in found if t.kind == k), default=0.0) for k in (WHOLE, PART)}


def _tests(system: System) -> tuple[list[Test], int]:
    """All tests of all joints, and the most periods of a record."""
    n, limits = system.n, system.equations.thresholds
    sums = [_Sums(limits.adequacy) for _ in range(n)]
    most = 0
    for i, r in enumerate(system.rows):
        rows = system.periods[i]
        if rows is None:
            continue
        most = max(most, -(-len(r.effort) // rows))
        for j in range(n):
            moving = r.moving[:, j]
            table = folded(np.where(moving, system.residuals[i][:, j], np.nan), rows)
            errors = np.zeros(table.shape) if r.repeated is None else folded(r.repeated[:, j], rows)
            share = independent_rows(table, limits.evidence)
            sums[j].add(i, table, share, errors)
    found = [s.whole(j, n) for j, s in enumerate(sums)]
    return found + [t for j, s in enumerate(sums) for t in s.parts(j, n)], most


def independent_rows(table: Array, limits: EvidenceThresholds) -> float:
    """Share of a record's rows that count as independent, from what differs between its periods."""
    there = np.isfinite(table)
    values = np.where(there, table, 0.0)
    mean = values.sum(axis=0, keepdims=True) / np.maximum(there.sum(axis=0, keepdims=True), 1)
    return independent(np.where(there, values - mean, 0.0).ravel(), limits)
