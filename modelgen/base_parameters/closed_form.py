"""Factors found numerically, as formulas in the arm's geometry symbols.

The oracle is asked again with other values of the symbols; a factor that is a monomial with small
integer powers, or a sum of few such, shows itself so and is checked on values not used to find it.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence

import numpy as np
import sympy as sp

from modelgen.description.objects import geometry_symbol

Factors = dict[tuple[int, int], float]  # (dependent, kept) -> factor

_DEGREE = 3
_SAMPLES = 16


def closed_forms(
    symbols: Mapping[str, float], factors_at: Callable[[dict[str, float]], Factors], found: Factors
) -> dict[tuple[int, int], sp.Expr | float]:
    """`found` with a formula in place of each factor that changes with the symbols.

    factors_at: the oracle's factors for other values of the symbols. A factor for which no formula
    is found keeps its number.
    """
    if not symbols or not found:
        return dict(found)
    generator = np.random.default_rng(1)
    names = list(symbols)
    points = [
        {name: symbols[name] * (1.0 + 0.4 * generator.uniform(-1, 1)) for name in names}
        for _ in range(_SAMPLES)
    ]
    answers = [factors_at(point) for point in points]
    return {
        key: _formula(names, points, [a.get(key) for a in answers], value) for key, value in found.items()
    }


def _formula(
    names: Sequence[str], points: Sequence[Mapping[str, float]], values: Sequence[float | None], now: float
) -> sp.Expr | float:
    if any(v is None for v in values):
        return now
    y = np.array(values, dtype=float)
    if np.ptp(y) <= 1e-9 * abs(now):
        return now
    table = np.array([[point[name] for name in names] for point in points])
    powers = [
        p for p in itertools.product(range(-2, _DEGREE + 1), repeat=len(names)) if sum(map(abs, p)) <= _DEGREE
    ]
    columns = np.array([np.prod(table ** np.array(p), axis=1) for p in powers]).T
    for size in (1, 2, 3):
        if size == 3 and len(powers) > 30:
            break
        for chosen in itertools.combinations(range(len(powers)), size):
            part = columns[:, chosen]
            weights = np.linalg.lstsq(part, y, rcond=None)[0]
            if np.max(np.abs(part @ weights - y)) <= 1e-8 * np.max(np.abs(y)):
                return sp.Add(*(_term(names, powers[c], w) for c, w in zip(chosen, weights, strict=True)))
    return now


def _term(names: Sequence[str], powers: Sequence[int], weight: float) -> sp.Expr:
    number = sp.nsimplify(round(float(weight), 8)) if abs(weight) < 1e6 else sp.Float(weight)
    return sp.Mul(number, *(geometry_symbol(n) ** p for n, p in zip(names, powers, strict=True)))
