"""Finite Fourier series, whose speeds and accelerations are exact and whose period can be averaged over.

Swevers, Ganseman, Bilgin Tukel, De Schutter and Van Brussel (1997), equation (9), the coefficients being
those of the position: x(t) = x0 + sum over k of a_k sin(k w t) + b_k cos(k w t), w = 2 pi / period.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import null_space

from modelgen.numeric import Array


@dataclass(frozen=True)
class Basis:
    """Free coefficients of one coordinate: (x0, a_1 .. a_H, b_1 .. b_H) = span @ z.

    a_k and b_k are divided by k in z, so that all harmonics of one size in z have one peak speed.
    """

    period: float
    harmonics: int
    span: Array

    @property
    def size(self) -> int:
        """Number of free coefficients of a coordinate."""
        return int(self.span.shape[1])

    def signals(self, t: Array) -> tuple[Array, Array, Array]:
        """Matrices (N, size) that give x, dx and ddx at times t (N,) [s] from z."""
        k = np.arange(1, self.harmonics + 1)
        w = 2 * np.pi * k / self.period
        s, c = np.sin(np.outer(t, w)), np.cos(np.outer(t, w))
        one = np.ones((len(t), 1))
        x = np.hstack([one, s, c])
        dx = np.hstack([0 * one, w * c, -w * s])
        ddx = np.hstack([0 * one, -(w**2) * s, -(w**2) * c])
        return x @ self.span, dx @ self.span, ddx @ self.span

    def coefficients(self, z: Array) -> Array:
        """(x0, a_1 .. a_H, b_1 .. b_H) by coordinate, (n, 2 H + 1), from z (n, size)."""
        full: Array = z @ self.span.T
        return full


def basis(period: float, harmonics: int, rest: bool) -> Basis:
    """The series; with `rest` those that start (and end) with zero speed and acceleration."""
    k = np.arange(1, harmonics + 1, dtype=np.float64)
    scale = np.concatenate([[1.0], 1 / k, 1 / k])
    span = np.diag(scale)
    if rest:
        zero = np.zeros(harmonics)
        speed = np.concatenate([[0.0], k, zero])
        acceleration = np.concatenate([[0.0], zero, k**2])
        free = null_space(np.array([speed, acceleration])[:, 1:] * scale[1:])
        span = np.zeros((2 * harmonics + 1, 2 * harmonics - 1))
        span[0, 0] = 1.0
        span[1:, 1:] = scale[1:, None] * free
    return Basis(period, harmonics, span)
