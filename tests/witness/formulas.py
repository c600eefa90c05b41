"""Printed groups read back: sums and products of names and numbers, nothing else."""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable, Mapping, Sequence

_BINARY: dict[type[ast.operator], Callable[[float, float], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}


def value(text: str, names: Mapping[str, float]) -> float:
    """The value of a printed expression; KeyError for a name that is not known."""

    def walk(node: ast.expr) -> float:
        if isinstance(node, ast.BinOp):
            return _BINARY[type(node.op)](walk(node.left), walk(node.right))
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            return -walk(node.operand)
        if isinstance(node, ast.Name):
            return math.pi if node.id == "pi" else names[node.id]
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            return {"sin": math.sin, "cos": math.cos}[node.func.id](*map(walk, node.args))
        assert isinstance(node, ast.Constant), ast.dump(node)
        return float(node.value)

    return walk(ast.parse(text, mode="eval").body)


def factors(text: str, names: Sequence[str], symbols: Mapping[str, float]) -> dict[str, float]:
    """Factors of the parameters `names` in a linear expression, zeros left out."""
    nothing = dict.fromkeys(names, 0.0) | dict(symbols)
    found = {name: value(text, nothing | {name: 1.0}) for name in names}
    return {name: factor for name, factor in found.items() if factor}
