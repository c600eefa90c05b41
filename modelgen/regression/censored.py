"""Least squares where some readings only say between which bounds a value was, or beyond one (Tobin 1958)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import log_ndtr

from modelgen.numeric import Array

STEPS = 30  # of Newton's method, at most
SETTLED = 1e-6  # of the likelihood's logarithm, by which a step changes it at the end
FAR = 1e6  # deviations: nothing is beyond
NORMAL = 1.4826  # of normal noise, over the median of its size
PART = 0.03  # of the width of bounds, that noise is at least where nothing else says how large it is
SINGULAR = 1e-10  # of the largest eigenvalue, below which samples say nothing of a direction


@dataclass(frozen=True)
class Samples:
    """Samples of one joint. columns: (M, p); value: (M,); side: (M,), 1 where the truth is `value` or more,
    -1 where it is that or less, 0 where it is what was read. width: by how much more or less at most, (M,) or
    one for all.
    """

    columns: Array
    value: Array
    side: NDArray[np.intp]
    width: float | Array = np.inf


def censored(samples: Sequence[Samples], theta: Array) -> Array:
    """Parameters (p,) of the largest likelihood of normal noise, whose size by joint is what `theta` leaves.

    Given that size the likelihood has one maximum (Olsen 1978): Newton's method finds it from anywhere.
    """
    sizes = [_size(x, theta) for x in samples]
    scale = np.sqrt(sum(((x.columns / s) ** 2).sum(axis=0) for x, s in zip(samples, sizes, strict=True)))
    scale[scale == 0.0] = 1.0
    now, slope, bend = _likelihood(samples, sizes, theta)
    for _ in range(STEPS):
        step = np.linalg.pinv(bend / np.outer(scale, scale), rcond=SINGULAR, hermitian=True) @ (slope / scale)
        step = step / scale
        for _ in range(STEPS):
            tried = _likelihood(samples, sizes, theta + step)
            if tried[0] >= now:
                break
            step = step / 2.0
        else:
            break
        before, theta = now, theta + step
        now, slope, bend = tried
        if now - before <= SETTLED:
            break
    return theta


def _size(x: Samples, theta: Array) -> float:
    """Size of what is left of the samples that were read, as few that are far off do not change it.

    Where all are known between bounds alone, by how much the fit leaves these, and a part of their width.
    """
    off = x.value - x.columns @ theta
    plain = x.side == 0
    if plain.any():
        return max(NORMAL * float(np.median(np.abs(off[plain]))), 1e-300)
    least = float(np.min(x.width, initial=np.inf))
    if not np.isfinite(least) or not len(off):
        return 1.0
    inside = -x.side * off
    beyond = np.maximum(np.maximum(-inside, inside - x.width), 0.0)
    return max(float(np.sqrt(np.mean(beyond**2))), PART * least)


def _likelihood(
    samples: Sequence[Samples], sizes: Sequence[float], theta: Array
) -> tuple[float, Array, Array]:
    """Logarithm, its slope (p,), and the negative of its second derivatives (p, p)."""
    total, slope, bend = 0.0, np.zeros(len(theta)), np.zeros((len(theta),) * 2)
    for x, size in zip(samples, sizes, strict=True):
        z = (x.columns @ theta - x.value) / size
        plain, sided = x.side == 0, x.side != 0
        total -= 0.5 * float(z[plain] @ z[plain])
        side = x.side[sided]
        u, width = side * z[sided], np.minimum(np.broadcast_to(x.width, z.shape)[sided] / size, FAR)
        share = _log_share(u, width)
        total += float(share.sum())
        near, far = (np.exp(-0.5 * v**2 - 0.5 * np.log(2 * np.pi) - share) for v in (u, u - width))
        first, second = -z, np.ones_like(z)
        first[sided] = side * (near - far)
        second[sided] = (near - far) ** 2 + u * near - (u - width) * far
        slope += x.columns.T @ first / size
        bend += (x.columns * second[:, None]).T @ x.columns / size**2
    return total, slope, bend


def _log_share(u: Array, width: Array) -> Array:
    """Logarithm of the share of normal noise between u - width and u, (M,) each."""
    # of two bounds on the same side of the mean those below it are told apart
    above = u > width
    high, low = np.where(above, width - u, u), np.where(above, -u, u - width)
    most = log_ndtr(high)
    return np.asarray(most + np.log1p(-np.minimum(np.exp(log_ndtr(low) - most), 1.0 - 1e-15)))
