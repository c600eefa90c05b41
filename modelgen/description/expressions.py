"""Arithmetic in the description: "pi/2", "90 deg", "d3/2 + 0.1". Nothing is ever executed.

The text is parsed to a syntax tree, and the tree is walked with a whitelist of node types.
Length, depth and exponents are bounded, so no text can keep the reader busy.
"""

from __future__ import annotations

import ast
import math
import re
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import sympy as sp

from modelgen.symbolic import Scalar, geometry_symbol

MAX_LENGTH = 200
MAX_DEPTH = 64
MAX_EXPONENT = 64
MAX_DEGREE = 64

UNITS: Mapping[str, tuple[str, float]] = {
    "deg": ("angle", math.pi / 180),
    "rad": ("angle", 1.0),
    "mm": ("length", 1e-3),
    "cm": ("length", 1e-2),
    "m": ("length", 1.0),
}
FUNCTIONS: Mapping[str, tuple[Callable[[float], float], Callable[[sp.Expr], sp.Expr]]] = {
    "sin": (math.sin, sp.sin),
    "cos": (math.cos, sp.cos),
    "tan": (math.tan, sp.tan),
    "asin": (math.asin, sp.asin),
    "acos": (math.acos, sp.acos),
    "atan": (math.atan, sp.atan),
    "sqrt": (math.sqrt, sp.sqrt),
}
_OPERATORS: Mapping[type[ast.operator], str] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
    ast.Pow: "**",
}
# "90 deg", "90deg", "(a + b) mm"; but "d3m" is a name.
_UNIT_AT_END = re.compile(r"(.*?)(?<![A-Za-z0-9_])([0-9]+(?:[eE][0-9]+)?)?(deg|rad|mm|cm|m)\s*", re.DOTALL)
_HINTS = {"^": "; a power is written **", "°": '; degrees are written "90 deg"', "π": "; write pi"}
# "2 kg"; but 1e5 is a number, and 2 pi lacks its sign of multiplication.
_OTHER_UNIT = re.compile(
    r"[-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?\s*(?![eE][-+]?[0-9]|(?:pi|j|if)\b)([A-Za-z%][\w%*/^ .]*)"
)
_FOREIGN = re.compile(r"[^0-9A-Za-z_.+\-*/() ]")


class ExpressionError(ValueError):
    """The text is no expression of the allowed kind; the message says what is wrong with it."""


@dataclass(frozen=True)
class Quantity:
    """A value in SI units, and the SymPy expression that gives it where symbols occur in it.

    `degree` bounds the powers that SymPy may be asked to multiply out.
    """

    value: float
    expression: sp.Expr | None = None
    degree: int = 0

    @property
    def scalar(self) -> Scalar:
        """The expression where there is one, else the number."""
        return self.value if self.expression is None else self.expression

    @property
    def symbolic(self) -> sp.Expr:
        """The quantity as a SymPy expression; small whole numbers stay whole, for legible printing."""
        if self.expression is not None:
            return self.expression
        whole = self.value.is_integer() and abs(self.value) < 1e6
        return sp.Integer(int(self.value)) if whole else sp.Float(self.value)


def evaluate(raw: float | str, kind: str, symbols: Mapping[str, float] | None = None) -> Quantity:
    """Value of a number or an expression, in SI units (rad, m).

    `kind` is "angle", "length", "plain" (no unit allowed) or "any" (either unit allowed).
    `symbols` maps the names that may occur to their values. Raises ExpressionError.
    """
    if isinstance(raw, str):
        text, factor = _split_unit(raw, kind)
        if other := _OTHER_UNIT.fullmatch(text):
            reads = ", ".join(name for name, (of, _) in UNITS.items() if kind in (of, "any"))
            here = f"'{other[1]}' is none of the units {reads}" if reads else "no unit is read here"
            raise ExpressionError(f"{here}; write the number alone, in SI units")
        tree = _parse(text, unit=text != raw.strip())
        quantity = _walk(tree, symbols or {}, 0)
        if factor != 1.0:
            quantity = _combine("*", quantity, Quantity(factor))
    else:
        try:
            quantity = Quantity(float(raw))
        except OverflowError:
            raise ExpressionError("the number is too large") from None
    return _finite(quantity)


def _split_unit(raw: str, kind: str) -> tuple[str, float]:
    if len(raw) > MAX_LENGTH:
        raise ExpressionError(f"the expression has {len(raw)} characters, at most {MAX_LENGTH} are read")
    match = _UNIT_AT_END.fullmatch(raw)
    if match is None:
        return raw.strip(), 1.0
    text, unit = (match[1] + (match[2] or "")).strip(), match[3]
    if not text:
        raise ExpressionError(f"a number is missing before the unit '{unit}'")
    of, factor = UNITS[unit]
    if kind == "plain":
        raise ExpressionError(f"the unit '{unit}' cannot stand here, expected a plain number")
    if kind not in (of, "any"):
        expected = ", ".join(name for name, (k, _) in UNITS.items() if k == kind)
        raise ExpressionError(f"'{unit}' is a unit of {of}, expected {_with_article(kind)} ({expected})")
    return text, factor


def _with_article(kind: str) -> str:
    return f"an {kind}" if kind[0] in "aeiou" else f"a {kind}"


def _parse(text: str, unit: bool) -> ast.expr:
    foreign = _FOREIGN.search(text)
    if foreign:
        raise ExpressionError(f"{foreign[0]!r} cannot be part of an expression{_HINTS.get(foreign[0], '')}")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            tree = ast.parse(text, mode="eval").body
    except (SyntaxError, ValueError, MemoryError, RecursionError):
        many = re.search(r"\b(deg|rad|mm|cm|m)\b", text) or re.search(r"\d(deg|rad|mm|cm|m)\b", text)
        hint = "; a unit stands once, at the end, for the whole expression" if many else ""
        raise ExpressionError(f"this is no arithmetic expression{hint}") from None
    if (
        unit
        and isinstance(tree, ast.BinOp)
        and isinstance(tree.op, ast.Add | ast.Sub)
        and tree.col_offset == 0
    ):
        raise ExpressionError(
            f"the unit could belong to the last term or to the sum; write ({text}) with the unit"
        )
    return tree


def _walk(node: ast.expr, symbols: Mapping[str, float], depth: int) -> Quantity:
    if depth > MAX_DEPTH:
        raise ExpressionError(f"the expression is nested deeper than {MAX_DEPTH} levels")
    match node:
        case ast.Constant(value=bool()):
            pass
        case ast.Constant(value=int() | float() as number):
            try:
                return _finite(Quantity(float(number)))
            except OverflowError:
                raise ExpressionError("a number in it is too large") from None
        case ast.Name(id=name):
            return _name(name, symbols)
        case ast.UnaryOp(op=ast.UAdd()):
            return _walk(node.operand, symbols, depth + 1)
        case ast.UnaryOp(op=ast.USub()):
            return _combine("*", Quantity(-1.0), _walk(node.operand, symbols, depth + 1))
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
            first = _walk(left, symbols, depth + 1)
            return _combine(_OPERATORS[type(op)], first, _walk(right, symbols, depth + 1))
        case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in FUNCTIONS:
            return _apply(name, _walk(argument, symbols, depth + 1))
        case ast.Call(func=ast.Name(id=name)) if name in FUNCTIONS:
            raise ExpressionError(f"{name}() takes one argument")
        case ast.Call(func=ast.Name(id=name)):
            raise ExpressionError(f"the function '{name}' is not known, available: {', '.join(FUNCTIONS)}")
        case _:
            pass
    raise ExpressionError(
        "only numbers, + - * / **, parentheses, pi, functions and the arm's symbols are allowed"
    )


def _name(name: str, symbols: Mapping[str, float]) -> Quantity:
    if name == "pi":
        return Quantity(math.pi)
    if name in symbols:
        return Quantity(symbols[name], geometry_symbol(name), 1)
    if name in UNITS:
        raise ExpressionError(f"'{name}' is a unit; a unit stands once, at the end, for the whole expression")
    if name in FUNCTIONS:
        raise ExpressionError(f"the function '{name}' needs its argument in parentheses")
    raise ExpressionError(f"the name '{name}' is not known, available: {', '.join(['pi', *symbols])}")


def _combine(operator: str, a: Quantity, b: Quantity) -> Quantity:
    """Numbers are folded as floats; SymPy sees an operation only where a symbol takes part."""
    if operator == "/" and b.value == 0.0:
        raise ExpressionError("it divides by zero")
    if operator == "**":
        return _power(a, b)
    value = {
        "+": lambda: a.value + b.value,
        "-": lambda: a.value - b.value,
        "*": lambda: a.value * b.value,
        "/": lambda: a.value / b.value,
    }[operator]()
    result = Quantity(value)
    if a.expression is not None or b.expression is not None:
        x, y = a.symbolic, b.symbolic
        expression = {"+": lambda: x + y, "-": lambda: x - y, "*": lambda: x * y, "/": lambda: x / y}[
            operator
        ]()
        degree = a.degree + b.degree if operator in "*/" else max(a.degree, b.degree)
        result = _bounded(value, expression, degree)
    return _finite(result)


def _power(a: Quantity, b: Quantity) -> Quantity:
    if b.expression is not None:
        raise ExpressionError("an exponent must be a number")
    if abs(b.value) > MAX_EXPONENT:
        raise ExpressionError(f"an exponent must lie within ±{MAX_EXPONENT}")
    try:
        value = a.value**b.value
    except ZeroDivisionError:
        raise ExpressionError("it divides by zero") from None
    except OverflowError:
        raise ExpressionError("its value is too large") from None
    if isinstance(value, complex):
        raise ExpressionError("it takes a root of a negative number")
    if a.expression is None:
        return _finite(Quantity(value))
    degree = math.ceil(a.degree * max(1.0, abs(b.value)))
    if degree > MAX_DEGREE:
        raise ExpressionError(f"powers of symbols go up to {MAX_DEGREE}")
    return _finite(_bounded(value, a.expression**b.symbolic, degree))


def _apply(name: str, argument: Quantity) -> Quantity:
    number, symbolic = FUNCTIONS[name]
    try:
        value = number(argument.value)
    except ValueError:
        raise ExpressionError(f"{name}({argument.value:g}) does not exist") from None
    if argument.expression is None:
        return _finite(Quantity(value))
    return _finite(_bounded(value, symbolic(argument.expression), 1))


def _bounded(value: float, expression: sp.Expr, degree: int) -> Quantity:
    """A symbolic result; SymPy may have cancelled the symbols, or found that it does not exist."""
    if expression.has(sp.zoo, sp.nan, sp.oo, sp.I):
        raise ExpressionError("its value is not finite")
    if degree > MAX_DEGREE:
        raise ExpressionError(f"powers of symbols go up to {MAX_DEGREE}")
    return Quantity(value, expression, degree) if expression.free_symbols else Quantity(value)


def _finite(quantity: Quantity) -> Quantity:
    if not math.isfinite(quantity.value):
        raise ExpressionError("its value is not finite")
    return quantity
