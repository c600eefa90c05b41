"""Values of a function to more digits than a double has, and so the same on every machine.

Sines and roots of one processor's vector unit differ from those of another one's in the last digit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from mpmath import MPContext
from numpy.typing import NDArray

from modelgen.functions.objects import Function, least_guarded
from modelgen.graph import Term

DIGITS = 40
CONTEXT = MPContext()
CONTEXT.dps = DIGITS


def _divided(x: Any, y: Any) -> Any:
    """x / y as IEEE 754 has it: what divides by zero may be one of two values of which the other is taken."""
    if y:
        return x / y
    return CONTEXT.sign(x) * CONTEXT.inf if x else CONTEXT.nan


_CALLS: Mapping[str, Callable[..., Any]] = {
    "neg": lambda x: -x,
    "add": lambda x, y: x + y,
    "sub": lambda x, y: x - y,
    "mul": lambda x, y: x * y,
    "div": _divided,
    "abs": abs,
    "pow": lambda x, y: x**y,
    "min": min,
    "max": max,
    "select": lambda c, x, y: x if c > 0 else y,
    **{
        name: getattr(CONTEXT, name)
        for name in (
            "sin",
            "cos",
            "tan",
            "asin",
            "acos",
            "atan",
            "atan2",
            "sqrt",
            "exp",
            "log",
            "tanh",
            "sign",
        )
    },
}


def exact_values(function: Function, given: Mapping[str, NDArray[np.float64]]) -> list[Any] | None:
    """All elements of the outputs, one output after the other, as numbers of CONTEXT; None where the function
    gives none, since a guard fails.

    given: inputs by name, (m,) each. For states in which every value is finite.
    """
    known: dict[int | tuple[str, int], Any] = {}

    def value(term: Term) -> Any:
        kind, *rest = term
        if kind == "const":
            return CONTEXT.mpf(rest[0])
        if kind == "in":
            return CONTEXT.mpf(float(given[rest[0]][rest[1]]))
        if kind == "let":
            return known[rest[0]]
        if kind == "call":
            kind, *rest = rest
        return _CALLS[kind](*map(value, rest))

    for statement in function.program.statements:
        found = value(statement.term)
        match statement.target:
            case ("guard", status) if not found > least_guarded(status):
                return None
        known[statement.target] = found
    zero = CONTEXT.mpf(0)
    return [known.get((o.name, i), zero) for o in function.outputs for i in range(o.size)]
