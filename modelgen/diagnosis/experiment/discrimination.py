"""The discrepancy of Atkinson and Fedorov (1975) says how well a motion tells two causes apart.

With cause j true, y = X b + C_j c_j; what model i leaves of it, |(I - P_i) C_j c_j|^2 with P_i the projection
on X and C_i, is the evidence against i that the motion can give, least over the nonlinear parameters of i.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from modelgen.diagnosis.candidates import Candidate, FittedCandidate, candidate_columns
from modelgen.diagnosis.equations import Equations, Rows
from modelgen.diagnosis.evidence import (
    NEGLIGIBLE,
    Autocorrelation,
    System,
    joints_of,
    weighted,
    whitened,
)
from modelgen.diagnosis.options.thresholds import ExperimentThresholds
from modelgen.numeric import Array
from modelgen.regression.weighted import orthonormal


@dataclass(frozen=True)
class Hypothesis:
    """A cause with all its values. others: values of the nonlinear parameter that it may have as well."""

    candidate: Candidate
    values: Mapping[str, float]
    theta: Array
    others: tuple[Mapping[str, float], ...]

    @property
    def parameters(self) -> int:
        """Number of parameters that the information criterion counts."""
        return len(self.theta) + len(self.values)


def hypothesis(trial: FittedCandidate, limits: ExperimentThresholds) -> Hypothesis:
    """The cause as it was fitted to the training records."""
    others: list[Mapping[str, float]] = []
    for name, value in trial.values.items():
        others += [
            {**trial.values, name: factor * value} for factor in limits.other_values if name != "harmonic"
        ]
    return Hypothesis(trial.candidate, dict(trial.values), trial.gain.values, tuple(others))


@dataclass(frozen=True)
class _Scale:
    """One way to weigh equations. stacked: columns (M, n, k) of all records to (R, k); joint: (R,), of rows;
    variance: of the noise, shares: of rows that are independent, by joint (n,); colour: of the noise, None
    where it is white or not known.
    """

    stacked: Callable[[Sequence[Array]], Array]
    joint: NDArray[np.intp]
    variance: Array
    shares: Array
    colour: Autocorrelation | None = None

    @property
    def rows(self) -> Array:
        """Numbers of rows by joint (n,)."""
        return np.bincount(self.joint, minlength=len(self.variance)).astype(float)

    @property
    def counts(self) -> Array:
        """Independent rows by joint (n,)."""
        return np.asarray(self.rows * self.shares)

    def drop(self, signal: Array, columns: Array) -> float:
        """Evidence that a model with these columns loses where the signal (R,) is there."""
        norms = np.linalg.norm(columns, axis=0)
        table = columns[:, norms > 0] / norms[norms > 0]
        left = (
            signal - table @ np.linalg.lstsq(table, signal, rcond=NEGLIGIBLE)[0] if len(table.T) else signal
        )
        power = np.bincount(self.joint, weights=left**2, minlength=len(self.variance))
        used = self.rows > 0
        ratio = power[used] / (self.rows[used] * np.maximum(self.variance[used], 1e-300))
        counted = float((self.counts[used] * np.log1p(ratio)).sum())
        if self.colour is None or not left.any():
            return counted
        unit = left[:, None] / np.linalg.norm(left)
        share = float(self.shares[self.joint] @ unit[:, 0] ** 2)
        hidden = share * float(self.colour.variance(unit)[0, 0])
        return counted / max(1.0, hidden)


class Discriminator:
    """A discriminator predicts what motions would say about hypotheses, in the training records' noise.

    system: the final one. equations: whose arm further columns are made for. base: its base parameters (p,).
    before: causes beside those in question, whose columns both models have.
    """

    def __init__(
        self, system: System, equations: Equations, base: Array, before: Sequence[Hypothesis] = ()
    ) -> None:
        self.system, self.equations, self.base, self.before = system, equations, base, before
        self.limits = equations.thresholds.experiment
        n = system.n
        self.white = system.white.rss / np.maximum(system.white.counts, 1)
        rows = np.maximum(np.bincount(system.plain.joint, minlength=n), 1)
        self.plain = system.plain.rss / rows
        self.shares = system.plain.counts / rows

    def columns(
        self, h: Hypothesis, values: Mapping[str, float], rows: Sequence[Rows], bases: Sequence[Array]
    ) -> list[Array] | None:
        """Columns (M, n, k) of every record; None where the cause cannot stand."""
        result = []
        for r, base in zip(rows, bases, strict=True):
            found = candidate_columns(h.candidate, values, self.equations.with_rows([r]), base)
            if found is None or not np.isfinite(found[0]).all():
                return None
            result += found
        return result

    def evidence(
        self,
        members: Sequence[Hypothesis],
        rows: Sequence[Rows],
        *,
        wide: bool = True,
        bases: Sequence[Array] | None = None,
    ) -> Array:
        """Expected delta BIC for i, j (k, k): of member i over member j where i is true; inf on the diagonal.

        wide: least over the other values of j's nonlinear parameter too. Zero where a cause cannot stand.
        Where j contains i there is only the penalty on what j has more, whatever the motion: infinite too.
        bases: base parameters by record where they differ, by a payload that is known.
        """
        bases = [self.base] * len(rows) if bases is None else bases
        shared = [r.columns for r in rows]
        for h in self.before:
            own = self.columns(h, h.values, rows, bases)
            if own is not None:
                shared = [np.concatenate(pair, axis=2) for pair in zip(shared, own, strict=True)]
        tables = [
            [self.columns(h, v, rows, bases) for v in (h.values, *(h.others if wide else ()))]
            for h in members
        ]
        found = np.full((len(members), len(members)), np.inf)
        for scale in (self._whitened(rows), self._weighted(rows)):
            basis = orthonormal(scale.stacked(shared))
            lists = [[None if c is None else _beyond(scale.stacked(c), basis) for c in t] for t in tables]
            part = self._compared(members, lists, scale)
            found = np.where(np.isinf(found), part, np.where(np.isinf(part), found, np.maximum(found, part)))
        return found

    def _compared(
        self, members: Sequence[Hypothesis], tables: Sequence[Sequence[Array | None]], scale: _Scale
    ) -> Array:
        """The matrix of `evidence` in one scale. tables: columns (R, k) of every member, by its values."""
        found = np.full((len(members), len(members)), np.inf)
        each = math.log(max(2.0, float(scale.counts.sum())))
        for i, true in enumerate(members):
            own = tables[i][0]
            for j, other in enumerate(members):
                first = tables[j][0]
                if i == j or (
                    own is not None and first is not None and inside(own, first, self.limits.min_left_share)
                ):
                    continue
                rests = (
                    []
                    if own is None
                    else [scale.drop(own @ true.theta, c) for c in tables[j] if c is not None]
                )
                found[i, j] = min(rests, default=0.0) + (other.parameters - true.parameters) * each
        return found

    def left_over(self, true: Hypothesis, other: Hypothesis, rows: Rows) -> tuple[Array, Array]:
        """Residuals (M, n) that `other` leaves where `true` is, nan at rest, and the noise's spread (n,)."""
        own, wrong = (self.columns(h, h.values, [rows], [self.base]) for h in (true, other))
        sizes = self.system.sizes * np.sqrt(self.plain)
        if own is None or wrong is None:
            return np.zeros(rows.effort.shape), sizes
        signal = own[0] @ true.theta
        table = np.concatenate([rows.columns, wrong[0]], axis=2) / sizes[None, :, None]
        stacked, right = table.reshape(-1, table.shape[2]), (signal / sizes).ravel()
        norms = np.linalg.norm(stacked, axis=0)
        norms[norms == 0] = 1.0
        kept = rows.moving.ravel()
        fit = np.linalg.lstsq(stacked[kept] / norms, right[kept], rcond=NEGLIGIBLE)[0] / norms
        return np.where(rows.moving, (right - stacked @ fit).reshape(signal.shape) * sizes, np.nan), sizes

    def _whitened(self, rows: Sequence[Rows]) -> _Scale:
        usable = self.system.usable(rows)
        return _Scale(
            lambda c: whitened(c, usable, self.system.whiteners),
            joints_of(usable),
            self.white,
            np.ones(self.system.n),
        )

    def _weighted(self, rows: Sequence[Rows]) -> _Scale:
        moving = [r.moving for r in rows]
        colour = self.system.plain.colour
        return _Scale(
            lambda c: weighted(c, moving, self.system.sizes),
            joints_of(moving),
            self.plain,
            self.shares,
            None if colour is None else colour.along(moving),
        )


def inside(columns: Array, others: Array, least: float) -> bool:
    """Whether the columns (R, k) are combinations of the others (R, m), to a share `least`."""
    left = _beyond(columns, orthonormal(others))
    return bool(np.linalg.norm(left) < least * np.linalg.norm(columns))


def _beyond(columns: Array, basis: Array) -> Array:
    """Take from columns (R, k) what lies in an orthonormal basis (R, b)."""
    return np.asarray(columns - basis @ (basis.T @ columns))
