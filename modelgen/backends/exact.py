"""Values of a function to more digits than a double has, and so the same on every machine.

Sines and roots of one processor's vector unit differ from those of another one's in the last digit.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping
from decimal import Context, Decimal, localcontext
from typing import Any

import numpy as np
from mpmath import MPContext
from numpy.typing import NDArray

from modelgen.functions.objects import Function, least_guarded
from modelgen.graph import Term

DIGITS = 76
# Of arithmetic; without traps infinities and what is no number come as IEEE 754 has them.
CONTEXT = Context(prec=DIGITS, traps=[])
_MORE = MPContext()  # of other functions
_MORE.dps = DIGITS + 2
_ZERO, _NAN = Decimal(0), Decimal("NaN")


def _called(function: Callable[..., Any]) -> Callable[..., Decimal]:
    """One of mpmath's functions; no number where its value is not real or beyond a double."""

    def call(*operands: Decimal) -> Decimal:
        if not all(map(_finite, operands)):
            return _NAN
        found = function(*(_MORE.mpf(str(x)) for x in operands))
        number = Decimal(_MORE.nstr(found, DIGITS)) if isinstance(found, _MORE.mpf) else _NAN
        return number if _finite(number) else _NAN

    return call


def _finite(x: Decimal) -> bool:
    """Whether a double has room for it."""
    return math.isfinite(float(x))


def _sign(x: Decimal) -> Decimal:
    return Decimal(int(x > 0) - int(x < 0))


def _first(before: Callable[[Decimal, Decimal], bool]) -> Callable[[Decimal, Decimal], Decimal]:
    """The one of two that comes before the other; no number where one is none."""
    return lambda x, y: _NAN if x.is_nan() or y.is_nan() else x if before(x, y) else y


CALLS: Mapping[str, Callable[..., Decimal]] = {
    "neg": operator.neg,
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": operator.truediv,
    "abs": abs,
    "sign": _sign,
    "min": _first(operator.le),
    "max": _first(operator.ge),
    "select": lambda c, x, y: x if c > 0 else y,
    "pow": _called(operator.pow),
    **{
        name: _called(getattr(_MORE, name))
        for name in ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sqrt", "exp", "log", "tanh")
    },
}


class ExactFunction:
    """A function of a model, evaluated in CONTEXT for one state after the other."""

    def __init__(self, function: Function) -> None:
        self.function = function
        # Operations on places in a list: results from its begin, numbers and elements of inputs from its end.
        self._steps: list[tuple[Callable[..., Decimal], list[int]]] = []
        self._leaves: dict[Term, int] = {}
        self._named: dict[int, int] = {}
        self._guards: list[tuple[int, Decimal]] = []
        self._outputs: dict[tuple[str, int], int] = {}
        for statement in function.program.statements:
            place = self._place(statement.term)
            if isinstance(statement.target, int):
                self._named[statement.target] = place
            elif statement.target[0] == "guard":
                self._guards.append((place, Decimal(least_guarded(statement.target[1]))))
            else:
                self._outputs[statement.target] = place

    def _place(self, term: Term) -> int:
        """Where the term's value is; what it takes becomes steps."""
        kind = term[0]
        if kind == "let":
            return self._named[term[1]]
        if kind in ("const", "in"):
            return self._leaves.setdefault(term, -1 - len(self._leaves))
        if kind == "call":
            _, kind, *operands = term
        else:
            operands = list(term[1:])
        self._steps.append((CALLS[kind], [self._place(operand) for operand in operands]))
        return len(self._steps) - 1

    def __call__(self, given: Mapping[str, NDArray[np.float64]]) -> list[Decimal] | None:
        """All elements of the outputs, one output after the other.

        given: inputs by name, (m,) each. None where the function gives no values: a guard fails, or one is
        not finite.
        """
        leaves = [leaf[1] if leaf[0] == "const" else given[leaf[1]][leaf[2]] for leaf in self._leaves]
        values = [_ZERO] * len(self._steps) + [Decimal(float(x)) for x in reversed(leaves)]
        with localcontext(CONTEXT):
            for place, (call, operands) in enumerate(self._steps):
                match operands:
                    case x, y:
                        values[place] = call(values[x], values[y])
                    case _:
                        values[place] = call(*[values[operand] for operand in operands])
            if not all(values[place] > least for place, least in self._guards):
                return None
        places = [self._outputs.get((o.name, i)) for o in self.function.outputs for i in range(o.size)]
        found = [_ZERO if place is None else values[place] for place in places]
        return found if all(map(_finite, found)) else None
