"""A regressor's columns by C that is compiled here, several samples at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.backends.body import body
from modelgen.backends.elements import Element
from modelgen.functions.objects import Function
from modelgen.native.columns import Columns
from modelgen.native.lanes import _HEAD


class RegressorColumns(Columns):
    """Selected columns of a regressor. elements: (c,), numbers of the computed elements, in order.

    weighted: whether each sample brings weights of the regressor's rows (n,) after the function's arguments.
    """

    def __init__(self, function: Function, *, weighted: bool = False) -> None:
        text, elements = text_of(function, weighted=weighted)
        super().__init__(text, len(elements))
        self.elements = np.array(elements, dtype=np.intp)


def text_of(function: Function, *, weighted: bool = False) -> tuple[str, list[int]]:
    """C of the function's first output, and which of its elements (by their number) it computes, in order.

    The text defines LANES, INPUTS, COLUMNS and columns(x, out): x, the elements of the arguments one after
    the other, and weights of the output's rows after them if asked for; out, what is computed of the output.
    What is beyond a domain comes as NaN, as in NumPy.
    """
    (output,) = function.outputs
    targets = [s.target for s in function.program.statements]
    computed = sorted(t[1] for t in targets if isinstance(t, tuple) and t[0] == output.name)
    dialect = _Lanes(function, {element: k for k, element in enumerate(computed)})
    given = sum(a.size for a in function.arguments)
    weights = (
        [f"out[{k}] *= x[{given + e // output.columns}];" for k, e in enumerate(computed)] if weighted else []
    )
    lines = [
        _HEAD,
        f"enum {{ INPUTS = {given + (output.rows if weighted else 0)}, COLUMNS = {len(computed)} }};",
        "static void columns(const lanes_t x[], lanes_t out[])",
        "{",
        *(f"    {line}" for line in [*body(function, {}, dialect), *weights]),
        "}",
    ]
    return "\n".join(lines) + "\n", computed


class _Lanes:
    """Statements over vectors."""

    def __init__(self, function: Function, places: dict[int, int]) -> None:
        self.places = places
        self.offsets: dict[str, int] = {}
        count = 0
        for argument in function.arguments:
            self.offsets[argument.name] = count
            count += argument.size

    def constant(self, value: float) -> str:
        """Set a constant in all lanes."""
        return f"K({float(value)!r})"

    def element(self, vector: str, index: int) -> str:
        """Read an element of the inputs, which lie one after the other."""
        return f"x[{self.offsets[vector] + index}]"

    def temporary(self, number: int) -> str:
        """t0, t1, ..."""
        return f"t{number}"

    def call(self, function: str, arguments: Sequence[str]) -> str:
        """A function of the text above."""
        return f"m_{function}({', '.join(arguments)})"

    def load(self, element: Element, source: str) -> str:
        """Nothing: elements have no names."""
        return ""

    def let(self, number: int, text: str) -> str:
        """A value that never changes."""
        return f"const lanes_t t{number} = {text};"

    def store(self, output: str, index: int, text: str) -> str:
        """One column."""
        return f"out[{self.places[index]}] = {text};"

    def remarked(self, statement: str, text: str) -> str:
        """Without: nobody reads it."""
        return statement

    def guard(self, status: int, text: str) -> str:
        """None, as in NumPy."""
        return ""
