"""The whitened equations of all training records, with what has been named so far among the columns."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset.processing.periods import noise_of
from modelgen.diagnosis.equations import Equations, Rows
from modelgen.diagnosis.evidence.likelihood import Evidence, StackedEquations, joints_of, weighted
from modelgen.diagnosis.evidence.noise import (
    Autocorrelation,
    Whitener,
    all_usable,
    correlations,
    whitened,
    whitener,
)
from modelgen.diagnosis.options.thresholds import EvidenceThresholds
from modelgen.numeric import Array
from modelgen.regression.weighted import moving_rows, rmse, weighted_fit


class System:
    """Equations with columns (M, n, p) for each record: the model's own and what was added.

    Weighted by joint, whitened, stacked joint after joint, record after record. noise: a system whose noise
    these equations have.
    """

    def __init__(
        self, equations: Equations, columns: Sequence[Array] | None = None, noise: System | None = None
    ) -> None:
        self.equations = equations
        self.columns = equations.columns if columns is None else columns
        rows, columns = self.rows, self.columns
        self.n = equations.n
        self.theta = weighted_fit(rows, columns)
        self.residuals = [r.effort - c @ self.theta for r, c in zip(rows, columns, strict=True)]
        self.whiteners: list[Whitener] = (
            noise.whiteners if noise else [self._whitener(j) for j in range(self.n)]
        )
        moving, usable = [r.moving for r in rows], self.usable(rows)
        self.sizes = np.array([max(_size(self, j), 1e-300) for j in range(self.n)])
        efforts, joint = [r.effort for r in rows], joints_of(usable)
        self.white = StackedEquations(
            lambda c: whitened(c, usable, self.whiteners),
            joint,
            np.bincount(joint, minlength=self.n).astype(float),
            columns,
            efforts,
            rows[0].baseline.said,
        )
        shares = np.array([_independent(self, j) for j in range(self.n)])
        coloured = correlations(self.residuals, moving, self.periods, self.limits)
        self.plain = StackedEquations(
            lambda c: weighted(c, moving, self.sizes),
            joints_of(moving),
            moving_rows(rows) * shares,
            columns,
            efforts,
            rows[0].baseline.said,
            None if coloured is None else Autocorrelation(coloured, moving, self.periods, self.limits),
        )

    @property
    def rows(self) -> Sequence[Rows]:
        """Rows of each record."""
        return self.equations.rows

    @property
    def periods(self) -> Sequence[int | None]:
        """Rows in a period of each record, None where nothing repeats."""
        return self.equations.periods

    @property
    def limits(self) -> EvidenceThresholds:
        """Thresholds by which evidence is counted."""
        return self.equations.thresholds.evidence

    @property
    def base(self) -> Array:
        """Base parameters (p,) as they are found beside all that was added."""
        return self.equations.base(self.theta)

    def usable(self, rows: Sequence[Rows]) -> list[NDArray[np.bool_]]:
        """Rows (M, n) of each record that can be whitened."""
        return [all_usable(r.moving, self.limits.whitening_order) for r in rows]

    def _whitener(self, j: int) -> Whitener:
        """From what differs between periods, which is noise alone, and what errors of the positions leave in
        every period alike. Else from all that is left, causes included.
        """
        residuals = [e[:, j] for e in self.residuals]
        moving = [r.moving[:, j] for r in self.rows]
        repeating = [k for k, p in enumerate(self.periods) if p is not None]
        if repeating:
            noise = [noise_of(residuals[k], moving[k], int(self.periods[k] or 0)) for k in repeating]
            if sum(int(flags.sum()) for _, flags in noise) > self.limits.min_noise_rows:
                errors = [self.rows[k].repeated for k in repeating]
                alike = [0.0 if e is None else e[:, j] for e in errors]
                together = [x + e for (x, _), e in zip(noise, alike, strict=True)]
                return whitener(together, [flags for _, flags in noise], self.limits)
        return whitener(residuals, moving, self.limits)

    @property
    def noise_known(self) -> bool:
        """Whether periods repeat, by which noise is distinguished from what the model lacks."""
        return any(p is not None for p in self.periods)

    @property
    def coloured(self) -> bool:
        """Whether the colour of the noise is known, and so how much of any evidence is chance."""
        return self.plain.colour is not None

    @property
    def price(self) -> float:
        """Times the evidence that it takes to name a cause: more where the noise's colour is not known."""
        return 1.0 if self.coloured else self.limits.unknown_noise_price

    @property
    def fair(self) -> StackedEquations:
        """The equations by which a law and a function of no law are compared: the more a function bends, the
        more noise of any colour it follows. Plain ones where no noise is known by which to whiten.
        """
        return self.white if self.noise_known else self.plain

    def gain(
        self,
        columns: Sequence[Array],
        extra: float = 0.0,
        positive: Sequence[bool] = (),
        *,
        passing: bool = False,
    ) -> Evidence | None:
        """Evidence of columns (M, n, k) of each record; None where they add nothing of their own.

        extra: parameters that were searched for besides. positive: (k,), columns whose value may not be
        negative; empty for none. passing: they do not repeat with the periods. The evidence is that of the
        whitened equations, or of the plain ones with as many of their rows as are independent for these
        columns, whichever is more: after a rest, and to what does not repeat, the filter is blind.
        """
        white = self.white.gain(columns, extra, positive)
        plain = self.plain.gain(columns, extra, positive, passing=passing)
        if white is None or plain is None:
            return white or plain
        return plain if plain.delta_bic > white.delta_bic else white


def _size(system: System, j: int) -> float:
    left = np.concatenate([e[r.moving[:, j], j] for e, r in zip(system.residuals, system.rows, strict=True)])
    return float(np.sqrt(np.mean(left**2))) if len(left) else 1.0


def _independent(system: System, j: int) -> float:
    """Share of independent rows, from what differs between periods or else from all that is left."""
    shares = []
    for e, r, p in zip(system.residuals, system.rows, system.periods, strict=True):
        values, flags = e[:, j], r.moving[:, j]
        if p is not None:
            values, flags = noise_of(values, flags, p)
        shares.append(independent(np.where(flags, values, 0.0), system.limits))
    return float(np.mean(shares))


def independent(values: Array, limits: EvidenceThresholds) -> float:
    """1 / (1 + 2 sum of squared autocorrelations): of a coloured series, for variances."""
    power = float(values @ values)
    if power <= 0:
        return 1.0
    most = min(limits.autocorrelation_lags, int(limits.max_lag_share * len(values)))
    lags = [float(values[k:] @ values[:-k]) / power for k in range(1, most)]
    return 1.0 / (1.0 + 2.0 * float(np.sum(np.square(lags))))


def mean_squares(system: System) -> Array:
    """Mean squares that the fit leaves on the moving rows, by joint (n,)."""
    return rmse(system.rows, system.columns, system.theta) ** 2


def whitened_fit(system: System) -> tuple[Array, Array]:
    """Least squares solution of the whitened equations and its standard deviations, (p,) each."""
    values = np.linalg.lstsq(system.white.matrix, system.white.right, rcond=1e-12)[0]
    return np.asarray(values), np.asarray(np.sqrt(np.maximum(0.0, np.diag(covariance(system)))))


def covariance(system: System) -> Array:
    """Covariance of the least squares solution of the whitened equations, (p, p)."""
    norms = np.linalg.norm(system.white.matrix, axis=0)
    norms[norms == 0] = 1.0
    inverse = np.linalg.pinv((system.white.matrix / norms).T @ (system.white.matrix / norms), rcond=1e-14)
    return np.asarray(inverse / np.outer(norms, norms))
