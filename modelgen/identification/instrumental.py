"""Instrumental variables: parameters that errors of the positions do not bias.

Least squares takes the regressor as exact. An instrument has the same truth and other errors (Reiersoel
1945): the regressor at the same phase of another period, where the motion repeats, or along the motion that
the model makes under the controller (Janot, Vandanjon and Gautier 2014). The difference of both estimates,
over the covariance that noise of the effort alone would give it, is the test of Durbin, Wu and Hausman
(Hausman 1978).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import special

from modelgen.numeric import Array
from modelgen.regression.autocovariance import autocovariance, autoregression, meat_of
from modelgen.regression.instruments import Instrument
from modelgen.regression.least_squares import Regression, Solution

SIGNIFICANCE = 1e-3
FEWEST = 10  # rows with a partner, per parameter


@dataclass(frozen=True)
class Comparison:
    """Least squares beside instrumental variables.

    solution: by instruments. statistic: chi-squared with `degrees` where least squares is not biased. weak:
    the instruments say too little, so that the test records are predicted far worse by it.
    """

    solution: Solution
    statistic: float
    degrees: int
    threshold: float
    simulated: bool = False  # whether the instruments are of a simulation
    weak: bool = False

    @property
    def biased(self) -> bool:
        """Whether errors of the positions bias least squares."""
        return self.statistic > self.threshold


def compared(
    regression: Regression, least: Solution, instruments: Sequence[Instrument | None]
) -> Comparison | None:
    """Both estimates on the rows that have an instrument; None where too few have one.

    instruments: of each record, None where it has none.
    """
    known, p = least.determined, least.determined.size
    rows = _rows(regression, instruments, known, least.sigma)
    if sum(len(y) for y, _, _, _ in rows) < FEWEST * p:
        return None
    size = int(known.sum())
    zw, ww = np.zeros((size, size)), np.zeros((size, size))
    zy, wy, zz = np.zeros(size), np.zeros(size), np.zeros(size)
    for y, w, z, _ in rows:
        zw, ww, zy, wy = zw + z.T @ w, ww + w.T @ w, zy + z.T @ y, wy + w.T @ y
        zz += (z**2).sum(axis=0)
    lengths = np.sqrt(np.diag(ww))
    by_instruments, by_squares = _inverse(zw, np.sqrt(zz), lengths), _inverse(ww, lengths, lengths)
    theta, plain = by_instruments @ zy, by_squares @ wy
    covariance, difference = np.zeros((size, size)), np.zeros((size, size))
    for joint in sorted({j for *_, j in rows}):
        own = [(y, w, z) for y, w, z, j in rows if j == joint]
        left = [y - w @ theta for y, w, _ in own]
        taps, power = autoregression(autocovariance(left, sum(len(e) for e in left)))
        for _, w, z in own:
            covariance += by_instruments @ meat_of(z, taps, power) @ by_instruments.T
            difference += meat_of(z @ by_instruments.T - w @ by_squares, taps, power)
    statistic, degrees = _statistic(theta - plain, difference)
    whole, spread = np.zeros(p), np.zeros((p, p))
    whole[known] = theta
    spread[np.ix_(known, known)] = covariance
    threshold = float(special.chdtri(degrees, SIGNIFICANCE)) if degrees else float("inf")
    return Comparison(replace(least, theta=whole, covariance=spread), statistic, degrees, threshold)


def _inverse(products: Array, left: Array, right: Array) -> Array:
    """Of products (p, p) of columns with these lengths, at unit length: columns of friction by counts of a
    motor are ten powers of ten longer than those of inertias, which would be lost.
    """
    a, b = (np.where(x > 0.0, x, 1.0) for x in (left, right))
    return np.asarray(np.linalg.pinv(products / np.outer(a, b), rcond=1e-12) / np.outer(b, a))


_Rows = tuple[Array, Array, Array, int]


def _rows(
    regression: Regression, instruments: Sequence[Instrument | None], known: NDArray[np.bool_], sigma: Array
) -> list[_Rows]:
    """Effort, columns, instruments of every record and joint, over the joint's residuals; the joint."""
    found: list[_Rows] = []
    for y, table, moving, z in zip(
        regression.effort, regression.columns, regression.moving, instruments, strict=True
    ):
        if z is None:
            continue
        for j in range(y.shape[1]):
            k = moving[:, j] & z.there[:, j]
            if not k.any():  # a joint that stands throughout
                continue
            own, other = table[k, j][:, known], z.columns[k, j][:, known]
            found.append((y[k, j] / sigma[j], own / sigma[j], other / sigma[j], j))
    return found


def _statistic(difference: Array, covariance: Array) -> tuple[float, int]:
    """difference' covariance^+ difference, and the rank; parameters in units of their own spread."""
    scale = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    kept = scale > 1e-12 * np.maximum(np.abs(difference), 1e-300)
    if not kept.any():
        return 0.0, 0
    d = difference[kept] / scale[kept]
    correlation = covariance[np.ix_(kept, kept)] / np.outer(scale[kept], scale[kept])
    values, vectors = np.linalg.eigh(correlation)
    large = values > 1e-6 * values[-1]
    turned = vectors[:, large].T @ d
    return float((turned**2 / values[large]).sum()), int(large.sum())
