"""Values of a description that may be symbolic: numbers, or expressions in an arm's named geometry."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

import sympy as sp

Scalar: TypeAlias = float | sp.Expr
Range: TypeAlias = tuple[float, float]


def geometry_symbol(name: str) -> sp.Symbol:
    """The SymPy symbol of one of an arm's named geometry values."""
    return sp.Symbol(name, real=True)


def number(value: Scalar, symbols: Mapping[str, float]) -> float:
    """The value for these values of the named symbols."""
    if isinstance(value, sp.Expr):
        return float(value.subs({geometry_symbol(name): x for name, x in symbols.items()}))
    return float(value)
