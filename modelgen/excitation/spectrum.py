"""Criteria on the observation matrix W, by its Gram matrix G = W^T W, with exact derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import casadi as ca
import numpy as np

from modelgen.numeric import Array

POWER = 8  # of the norm that stands for the largest and the smallest eigenvalue


def condition(w: Array, *, scaled: bool = True) -> float:
    """Condition number of W (rows, p), its columns scaled to unit norm (van der Sluis 1969) or as they are.

    Infinite where a column is zero.
    """
    norms = np.linalg.norm(w, axis=0)
    if not np.isfinite(norms).all() or (norms == 0).any():
        return float("inf")
    values = np.linalg.svd(w / norms if scaled else w, compute_uv=False)
    return float(values[0] / values[-1]) if values[-1] > 0 else float("inf")


def log_determinant(w: Array, unit: Array) -> float:
    """log det(W^T W) / p, columns divided by `unit` (p,): what a D-optimal trajectory makes largest."""
    sign, value = np.linalg.slogdet((w / unit).T @ (w / unit))
    return float(value) / w.shape[1] if sign > 0 else -float("inf")


def value_and_slope(criterion: str, gram: Array) -> tuple[float, Array]:
    """The criterion to be made small, and its derivative by G (p, p).

    cond: the logarithm of the condition number with column scaling, its extreme eigenvalues replaced by
    the norms (sum of lambda^s)^(1/s) and (sum of lambda^-s)^(-1/s), s = POWER, which are smooth and off by
    at most p^(1/s) each. d_optimal: -log det(G) / (2 p).
    """
    p = len(gram)
    diagonal = np.maximum(np.diag(gram), 1e-300)
    d = 1 / np.sqrt(diagonal)
    values, vectors = np.linalg.eigh(gram * np.outer(d, d))
    values = np.maximum(values, 1e-14)
    if criterion == "d_optimal":
        value = -0.5 * float(np.sum(np.log(values)) + np.sum(np.log(diagonal))) / p
        return value, (vectors / values) @ vectors.T * np.outer(d, d) * (-0.5 / p)
    up, down = (values / values[-1]) ** POWER, (values[0] / values) ** POWER
    value = 0.5 * float(np.log(values[-1] / values[0]) + (np.log(up.sum()) + np.log(down.sum())) / POWER)
    slopes = 0.5 * (up / up.sum() - down / down.sum()) / values
    s = (vectors * slopes) @ vectors.T
    own = np.sum(s * ((vectors * values) @ vectors.T), axis=1)
    return value, s * np.outer(d, d) - np.diag(own / diagonal)


class Criterion(ca.Callback):
    """`value_and_slope` as a CasADi function of G."""

    def __init__(self, criterion: str, size: int) -> None:
        ca.Callback.__init__(self)
        self._criterion, self._size = criterion, size
        self._slope: list[Any] = []  # CasADi keeps no reference of its own
        self.construct("criterion", {})

    def get_sparsity_in(self, _: int) -> ca.Sparsity:
        """G, dense."""
        return ca.Sparsity.dense(self._size, self._size)

    def eval(self, arguments: Sequence[ca.DM]) -> list[float]:
        """The value."""
        return [value_and_slope(self._criterion, arguments[0].full())[0]]

    def has_reverse(self, directions: int) -> bool:
        """One direction is all that a gradient takes."""
        return bool(directions == 1)

    def get_reverse(
        self, _: int, name: str, inputs: Sequence[str], outputs: Sequence[str], options: Any
    ) -> Any:
        """The derivative as a function of (G, value, weight)."""
        slope = _Slope(self._criterion, self._size, name, options)
        self._slope.append(slope)
        return slope


class _Slope(ca.Callback):
    def __init__(self, criterion: str, size: int, name: str, options: Any) -> None:
        ca.Callback.__init__(self)
        self._criterion, self._size = criterion, size
        self.construct(name, options)

    def get_n_in(self) -> int:
        return 3

    def get_n_out(self) -> int:
        return 1

    def get_sparsity_in(self, index: int) -> ca.Sparsity:
        size = self._size if index == 0 else 1
        return ca.Sparsity.dense(size, size)

    def get_sparsity_out(self, _: int) -> ca.Sparsity:
        return ca.Sparsity.dense(self._size, self._size)

    def eval(self, arguments: Sequence[ca.DM]) -> list[Array]:
        slope = value_and_slope(self._criterion, arguments[0].full())[1]
        return [float(arguments[2]) * slope]
