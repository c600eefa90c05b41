"""Factors found numerically, as formulas in the arm's geometry symbols.

The oracle is asked again with other values of the symbols; a factor that is a monomial with small
integer powers, or a sum of few such, shows itself so and is checked on values not used to find it.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Collection, Mapping, Sequence
from fractions import Fraction

import numpy as np
import sympy as sp

from modelgen.description.objects import geometry_symbol

Factors = dict[tuple[int, int], float]  # (dependent, kept) -> factor

_SAMPLES = 16
_NAMES = 4  # most symbols in one factor
_DEGREE = 4  # of a single monomial; sums of monomials go to one less


def closed_forms(
    symbols: Mapping[str, float],
    factors_at: Callable[[dict[str, float]], Factors],
    found: Factors,
    held: Collection[str] = (),
) -> dict[tuple[int, int], sp.Expr | float]:
    """`found` with a formula in place of each factor that changes with the symbols.

    factors_at: the oracle's factors for other values of the symbols, of which those in `held` keep
    theirs. A factor for which no formula is found keeps its number.
    """
    names = [name for name in symbols if name not in held]
    if not names or not found:
        return dict(found)
    generator = np.random.default_rng(1)

    def elsewhere(moved: Collection[str]) -> dict[str, float]:
        return {
            name: value * (1.0 + 0.4 * generator.uniform(-1, 1)) if name in moved else value
            for name, value in symbols.items()
        }

    alone = {name: factors_at(elsewhere([name])) for name in names}
    needed = {key: [n for n in names if _differ(alone[n].get(key), value)] for key, value in found.items()}
    moved = {name for which in needed.values() for name in which}
    points = [elsewhere(moved) for _ in range(_SAMPLES if moved else 0)]
    answers = [factors_at(point) for point in points]
    return {
        key: _formula(needed[key], points, [a.get(key) for a in answers], value)
        for key, value in found.items()
    }


def _differ(other: float | None, value: float) -> bool:
    return other is None or abs(other - value) > 1e-9 * abs(value)


def _formula(
    names: Sequence[str], points: Sequence[Mapping[str, float]], values: Sequence[float | None], now: float
) -> sp.Expr | float:
    if not 0 < len(names) <= _NAMES or any(v is None for v in values):
        return now
    y = np.array(values, dtype=float)
    table = np.array([[point[name] for name in names] for point in points])
    powers = sorted(
        (p for p in itertools.product(range(-2, _DEGREE + 1), repeat=len(names)) if _size(p) <= _DEGREE),
        key=_size,
    )
    low = [p for p in powers if _size(p) < _DEGREE]
    trials = itertools.chain(
        ((p,) for p in powers),
        itertools.combinations(low, 2),
        itertools.combinations([p for p in low if min(p) >= 0], 3),
    )
    for chosen in trials:
        part = np.array([np.prod(table ** np.array(p), axis=1) for p in chosen]).T
        weights = np.linalg.lstsq(part, y, rcond=None)[0]
        if np.max(np.abs(part @ weights - y)) <= 1e-8 * np.max(np.abs(y)):
            return sp.Add(*(_term(names, p, w) for p, w in zip(chosen, weights, strict=True)))
    return now


def _size(powers: Sequence[int]) -> int:
    return sum(map(abs, powers))


def _term(names: Sequence[str], powers: Sequence[int], weight: float) -> sp.Expr:
    factors = (geometry_symbol(n) ** p for n, p in zip(names, powers, strict=True))
    return sp.Mul(_exact(float(weight)), *factors)


def _exact(value: float) -> sp.Expr:
    """A small fraction, or one times pi or pi^2 (screws have 2 pi / lead), where `value` is one."""
    for power in range(3):
        ratio = value / math.pi**power
        fraction = Fraction(ratio).limit_denominator(1000)
        if abs(float(fraction) - ratio) <= 1e-9 * abs(ratio):
            return sp.Rational(fraction.numerator, fraction.denominator) * sp.pi**power
    return sp.Float(value)
