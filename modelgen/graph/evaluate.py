"""Values of expressions over many samples at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from modelgen.graph.graph import ADD, CONST, DIV, INPUT, MUL, Expr
from modelgen.graph.lowering import reachable
from modelgen.numeric import Array


def _select(condition: Array, a: Array, b: Array) -> Array:
    return np.asarray(np.where(condition > 0, a, b))


_FUNCTIONS: dict[str, Callable[..., Array]] = {
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "sqrt": np.sqrt,
    "exp": np.exp,
    "log": np.log,
    "tanh": np.tanh,
    "abs": np.abs,
    "sign": np.sign,
    "atan2": np.arctan2,
    "pow": np.power,
    "min": np.minimum,
    "max": np.maximum,
    "select": _select,
}


def evaluate(expressions: Sequence[Expr], inputs: Mapping[str, Array], samples: int) -> Array:
    """Values of `expressions`, samples x len(expressions).

    `inputs`: by name, samples x size. For checks and for the rank of the regressor; what is used
    again and again is a program of the NumPy backend.
    """
    result = np.zeros((samples, len(expressions)))
    if not expressions:
        return result
    graph = expressions[0].graph
    value: dict[int, Array | float] = {}

    def signed(key: int) -> Array | float:
        return -value[key >> 1] if key & 1 else value[key >> 1]

    for node in reachable(graph, [e.key for e in expressions]):
        op = graph.op[node]
        if op == CONST:
            value[node] = graph.number[node]
        elif op == INPUT:
            value[node] = inputs[graph.name[node]][:, int(graph.number[node])]
        else:
            operands = [signed(key) for key in graph.args[node]]
            if op == ADD:
                value[node] = operands[0] + operands[1]
            elif op == MUL:
                value[node] = operands[0] * operands[1]
            elif op == DIV:
                value[node] = operands[0] / operands[1]
            else:
                value[node] = _FUNCTIONS[graph.name[node]](*operands)
    for column, expression in enumerate(expressions):
        result[:, column] = signed(expression.key)
    return result
