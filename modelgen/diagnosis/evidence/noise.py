"""How much noise of one colour hides of columns: slow columns in slow noise have fewer independent rows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import fftconvolve, lfilter

from modelgen.dataset.processing.periods import noise_of
from modelgen.diagnosis.options.thresholds import EvidenceThresholds
from modelgen.numeric import Array


class Autocorrelation:
    """Autocorrelation of noise in rows stacked record after record, joint after joint in each.

    correlations: (n, lags) of each joint's noise, from lag 0, tapered so that no combination of rows has a
    negative variance (Newey and West 1987). moving: (M, n) of each record. periods: rows in a period of each.
    limits: by which correlations are measured anew.
    """

    def __init__(
        self,
        correlations: Array,
        moving: Sequence[NDArray[np.bool_]],
        periods: Sequence[int | None],
        limits: EvidenceThresholds,
    ) -> None:
        self.correlations, self.moving, self.periods = correlations, moving, periods
        self.limits, self.lags = limits, correlations.shape[1]
        self.kernels = [np.concatenate([c[:0:-1], c]) for c in correlations]
        self.places: list[list[tuple[slice, NDArray[np.intp]]]] = [[] for _ in correlations]
        self.length, row = 0, 0
        for flags in moving:
            for j, places in enumerate(self.places):
                at = np.flatnonzero(flags[:, j])
                places.append((slice(row, row + len(at)), self.length + at))
                row += len(at)
            self.length += len(flags) + self.lags

    def of(self, left: Array) -> Autocorrelation:
        """Autocorrelation of what is left, (R,), once what does not repeat is subtracted."""
        residuals = [np.zeros(flags.shape) for flags in self.moving]
        ends = np.cumsum([len(flags) + self.lags for flags in self.moving])
        for j, places in enumerate(self.places):
            for (rows, at), table, end in zip(places, residuals, ends, strict=True):
                table[at - (end - len(table) - self.lags), j] = left[rows]
        found = correlations(residuals, self.moving, self.periods, self.limits)
        if found is None:
            return self
        return Autocorrelation(found, self.moving, self.periods, self.limits)

    def along(self, moving: Sequence[NDArray[np.bool_]]) -> Autocorrelation:
        """Autocorrelation in rows of other motions."""
        return Autocorrelation(self.correlations, moving, [None] * len(moving), self.limits)

    def variance(self, columns: Array) -> Array:
        """Variance of the sums of noise of unit variance times columns (R, k): (k, k) (Bartlett 1946)."""
        found = np.zeros((columns.shape[1], columns.shape[1]))
        for kernel, places in zip(self.kernels, self.places, strict=True):
            spread = np.zeros((self.length, columns.shape[1]))
            for rows, at in places:
                spread[at] = columns[rows]
            if spread.any():
                found += spread.T @ fftconvolve(spread, kernel[:, None], mode="same", axes=0)
        return 0.5 * (found + found.T)


def correlations(
    residuals: Sequence[Array],
    moving: Sequence[NDArray[np.bool_]],
    periods: Sequence[int | None],
    limits: EvidenceThresholds,
) -> Array | None:
    """Autocorrelation of what differs between the periods of residuals (M, n) of each record, tapered: (n,
    lags).

    None where hardly anything repeats of some joint that moves: what is left has the colour of what the
    model lacks.
    """
    n, lags = residuals[0].shape[1], limits.autocorrelation_lags
    sums, counts = np.zeros((n, lags)), np.zeros(n)
    for e, flags, p in zip(residuals, moving, periods, strict=True):
        for j in range(n if p is not None else 0):
            values, there = noise_of(e[:, j], flags[:, j], int(p or 0))
            counts[j] += there.sum()
            count = min(lags, len(values))
            sums[j, :count] += [values[k:] @ values[: len(values) - k] for k in range(count)]
    moves = np.any([flags.any(axis=0) for flags in moving], axis=0)
    if (moves & (counts <= limits.min_noise_rows)).any() or not moves.any():
        return None
    return np.asarray(sums / np.maximum(sums[:, :1], 1e-300) * (1.0 - np.arange(lags) / lags))


@dataclass(frozen=True)
class Whitener:
    """Whitener of one joint: the prediction-error filter 1 - a1 z^-1 - ... and the size of what it leaves."""

    taps: Array
    size: float

    def __call__(self, values: Array, usable: NDArray[np.bool_]) -> Array:
        """(M, k) filtered and scaled to unit size, of the usable rows alone."""
        return np.asarray(lfilter(self.taps, 1.0, values, axis=0)[usable] / self.size)


def whitened(
    columns: Sequence[Array], usable: Sequence[NDArray[np.bool_]], whiteners: Sequence[Whitener]
) -> Array:
    """Columns (M, n, k) of each record, whitened by joint and stacked. usable: (M, n) of each record."""
    parts = []
    for table, flags in zip(columns, usable, strict=True):
        for j, white in enumerate(whiteners):
            block, rows = np.ascontiguousarray(table[:, j, :]), flags[:, j]
            parts.append(white(block, rows) if block.any() else np.zeros((rows.sum(), block.shape[1])))
    return np.concatenate(parts)


def all_usable(moving: NDArray[np.bool_], order: int) -> NDArray[np.bool_]:
    """`usable_rows` of every joint, (M, n)."""
    return np.column_stack([usable_rows(flags, order) for flags in moving.T])


def usable_rows(moving: NDArray[np.bool_], order: int) -> NDArray[np.bool_]:
    """Rows (M,) that have `order` moving rows before them."""
    run = np.zeros(len(moving), dtype=int)
    count = 0
    for i, flag in enumerate(moving):
        count = count + 1 if flag else 0
        run[i] = count
    return np.asarray(run > order)


def whitener(
    residuals: Sequence[Array], moving: Sequence[NDArray[np.bool_]], limits: EvidenceThresholds
) -> Whitener:
    """Fit a whitener to the residuals (M,) of one joint in all records, by least squares over the runs."""
    order, past, now = limits.whitening_order, [], []
    for residual, flags in zip(residuals, moving, strict=True):
        usable = np.flatnonzero(usable_rows(flags, order))
        past.append(np.column_stack([residual[usable - lag] for lag in range(1, order + 1)]))
        now.append(residual[usable])
    x, y = np.concatenate(past), np.concatenate(now)
    if len(y) < limits.min_fitted_rows_per_lag * order:
        left = np.concatenate([r[m] for r, m in zip(residuals, moving, strict=True)])
        size = float(np.sqrt(np.mean(left**2))) if len(left) else 1.0
        return Whitener(np.concatenate([[1.0], np.zeros(order)]), max(size, 1e-300))
    a = np.linalg.lstsq(x, y, rcond=None)[0]
    left = y - x @ a
    return Whitener(np.concatenate([[1.0], -a]), max(float(np.sqrt(np.mean(left**2))), 1e-300))
