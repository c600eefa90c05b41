"""Arithmetic over the columns of a log: "load / 885 * vin". Nothing is ever executed.

The text is parsed to a syntax tree, and the tree is walked with a whitelist of node types.
"""

from __future__ import annotations

import ast
import math
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from modelgen.numeric import Array

MAX_LENGTH = 200
MAX_DEPTH = 32
_FUNCTIONS: Mapping[str, Callable[[Array], Array]] = {
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "sqrt": np.sqrt,
    "abs": np.abs,
    "sign": np.sign,
}
_OPERATORS: Mapping[type[ast.operator], Callable[[Array, Array], Array]] = {
    ast.Add: np.add,
    ast.Sub: np.subtract,
    ast.Mult: np.multiply,
    ast.Div: np.divide,
    ast.Pow: np.power,
}


class FormulaError(ValueError):
    """The text is no formula of the allowed kind; the message says what is wrong with it."""


@dataclass(frozen=True, eq=False)
class Formula:
    """A formula, checked: the names of the columns it needs, and its value on arrays (N,)."""

    text: str
    names: tuple[str, ...]
    tree: ast.expr

    def __call__(self, columns: Mapping[str, Array]) -> Array:
        """The value for columns (N,) by name; a constant comes as an array of no dimension."""
        with np.errstate(all="ignore"):  # what is not finite is refused where the record is checked
            return np.asarray(_walk(self.tree, columns), dtype=np.float64)


def formula(text: str, columns: tuple[str, ...]) -> Formula:
    """The formula that `text` is, over the given columns. Raises FormulaError.

    A text that is the name of a column is that column, whatever characters the name has.
    """
    if text in columns:
        return Formula(text, (text,), ast.Name(text))
    if len(text) > MAX_LENGTH:
        raise FormulaError(f"the formula has {len(text)} characters, at most {MAX_LENGTH} are read")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            tree = ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError, MemoryError, RecursionError):
        raise FormulaError("this is neither a column nor a formula over columns") from None
    names: list[str] = []
    _check(tree, columns, names, 0)
    return Formula(text, tuple(dict.fromkeys(names)), tree)


def _check(node: ast.expr, columns: tuple[str, ...], names: list[str], depth: int) -> None:
    if depth > MAX_DEPTH:
        raise FormulaError(f"the formula is nested deeper than {MAX_DEPTH} levels")
    match node:
        case ast.Constant(value=value) if isinstance(value, int | float) and not isinstance(value, bool):
            if abs(value) > 1e300:
                raise FormulaError("the number is too large")
        case ast.Name(id="pi"):
            pass
        case ast.Name(id=name):
            if name not in columns:
                raise FormulaError(f"there is no column '{name}'")
            names.append(name)
        case ast.UnaryOp(op=ast.UAdd() | ast.USub(), operand=operand):
            _check(operand, columns, names, depth + 1)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
            _check(left, columns, names, depth + 1)
            _check(right, columns, names, depth + 1)
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in _FUNCTIONS:
            _check(argument, columns, names, depth + 1)
        case _:
            functions = ", ".join(_FUNCTIONS)
            raise FormulaError(f"expected columns, numbers, pi, + - * / ** and {functions}")


def _walk(node: ast.expr, columns: Mapping[str, Array]) -> Array:
    match node:
        case ast.Constant(value=value):
            assert isinstance(value, int | float)
            return np.asarray(value, dtype=np.float64)
        case ast.Name(id=name):
            return np.asarray(math.pi) if name == "pi" and name not in columns else columns[name]
        case ast.UnaryOp(op=op, operand=operand):
            inner = _walk(operand, columns)
            return -inner if isinstance(op, ast.USub) else inner
        case ast.BinOp(left=left, op=op, right=right):
            return _OPERATORS[type(op)](_walk(left, columns), _walk(right, columns))
        case ast.Call(func=ast.Name(id=name), args=[argument]):
            return _FUNCTIONS[name](_walk(argument, columns))
    raise AssertionError(ast.dump(node))
