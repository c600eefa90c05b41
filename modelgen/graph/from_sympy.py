"""Expressions of SymPy, in which transmissions and effects are written, become nodes of the graph."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import count

import sympy as sp

from modelgen.graph.graph import Expr, Graph

# (sine, cosine) of an angle that the caller already has, or None
Trigonometry = Callable[[sp.Expr], tuple[Expr, Expr] | None]

_CALLS = {
    sp.sin: "sin",
    sp.cos: "cos",
    sp.tan: "tan",
    sp.asin: "asin",
    sp.acos: "acos",
    sp.atan: "atan",
    sp.atan2: "atan2",
    sp.exp: "exp",
    sp.log: "log",
    sp.tanh: "tanh",
    sp.sign: "sign",
    sp.Abs: "abs",
    sp.Max: "max",
    sp.Min: "min",
}


@dataclass(frozen=True)
class _Call:
    """What an expression is evaluated with, and the values of its parts that are known."""

    graph: Graph
    bindings: Mapping[sp.Symbol, Expr]
    trigonometry: Trigonometry | None
    known: dict[int, Expr] = field(default_factory=dict)


_Step = Callable[[_Call], Expr]
REMEMBERED = 2048  # expressions: a law is asked for at many places of many functions


def from_sympy(
    graph: Graph,
    expression: sp.Expr,
    bindings: Mapping[sp.Symbol, Expr],
    trigonometry: Trigonometry | None = None,
) -> Expr:
    """The graph's value of `expression`, its symbols replaced by `bindings`.

    `trigonometry` may supply sine and cosine of an argument, so that an angle of the arm is not
    looked up twice. Raises KeyError for an unbound symbol and TypeError for an unknown function.
    """
    return _steps(sp.sympify(expression))(_Call(graph, bindings, trigonometry))


@lru_cache(maxsize=REMEMBERED)
def _steps(expression: sp.Expr) -> _Step:
    """How an expression is evaluated in any graph. What SymPy is asked for is asked once."""
    steps: dict[sp.Basic, _Step] = {}
    numbers = count()
    # What stands under a root is divided by through one reciprocal root: divisions are dear.
    rooted = {power.base for power in expression.atoms(sp.Pow) if _halves(power.exp) and 2 * power.exp % 2}

    def convert(node: sp.Basic) -> _Step:
        if node not in steps:
            steps[node] = _once(next(numbers), _step(node, convert, rooted))
        return steps[node]

    return convert(expression)


def _once(number: int, step: _Step) -> _Step:
    """The step of a part that may stand at several places of its expression."""

    def value(call: _Call) -> Expr:
        found = call.known.get(number)
        if found is None:
            found = call.known[number] = step(call)
        return found

    return value


_Convert = Callable[[sp.Basic], _Step]


def _step(node: sp.Basic, convert: _Convert, rooted: Collection[sp.Expr]) -> _Step:
    if isinstance(node, sp.Symbol):
        return lambda call: call.bindings[node]
    if node.is_number:
        number = float(node)
        return lambda call: call.graph.const(number)
    if isinstance(node, sp.Add):
        return _sum([convert(a) for a in node.args])
    if isinstance(node, sp.Mul):
        return _product(node, convert, rooted)
    if isinstance(node, sp.Pow):
        return _power(node, convert, rooted)
    if isinstance(node, sp.Piecewise):
        return _piecewise(node, convert)
    name = _CALLS.get(type(node))
    if name is None:
        raise TypeError(f"{type(node).__name__} has no counterpart in generated code")
    arguments = [convert(a) for a in node.args]
    if isinstance(node, sp.sin | sp.cos):
        return _of_angle(name, node.args[0], arguments[0])
    return _extreme(name, arguments) if name in ("max", "min") else _called(name, arguments)


def _called(name: str, arguments: list[_Step]) -> _Step:
    return lambda call: call.graph.call(name, *(a(call) for a in arguments))


def _of_angle(name: str, angle: sp.Expr, argument: _Step) -> _Step:
    def step(call: _Call) -> Expr:
        known = call.trigonometry(angle) if call.trigonometry else None
        return known[name == "cos"] if known else call.graph.call(name, argument(call))

    return step


def _extreme(name: str, arguments: list[_Step]) -> _Step:
    def step(call: _Call) -> Expr:
        values = [a(call) for a in arguments]
        result = values[0]
        for value in values[1:]:
            result = call.graph.call(name, result, value)
        return result

    return step


def _halves(exponent: sp.Expr) -> bool:
    """Whether the exponent is a small multiple of one half."""
    return bool(exponent.is_number and (2 * exponent).is_integer and abs(2 * exponent) <= 16)


def _sum(terms: list[_Step]) -> _Step:
    def step(call: _Call) -> Expr:
        values = [term(call) for term in terms]
        total = values[0]
        for value in values[1:]:
            total = total + value
        return total

    return step


def _product(node: sp.Mul, convert: _Convert, rooted: Collection[sp.Expr]) -> _Step:
    """Numerator over denominator, so that a product has at most one division."""
    factors: list[tuple[bool, _Step]] = []
    for factor in node.args:
        negative = isinstance(factor, sp.Pow) and factor.exp.is_number and factor.exp < 0
        below = negative and factor.base not in rooted
        factors.append((below, convert(sp.Pow(factor.base, -factor.exp) if below else factor)))

    def step(call: _Call) -> Expr:
        over, under = call.graph.one, call.graph.one
        for below, factor in factors:
            if below:
                under = under * factor(call)
            else:
                over = over * factor(call)
        return over / under

    return step


def _power(node: sp.Pow, convert: _Convert, rooted: Collection[sp.Expr]) -> _Step:
    base, exponent = convert(node.base), node.exp
    if not _halves(exponent):
        return _called("pow", [base, convert(exponent)])
    halves, negative, root = abs(int(2 * exponent)), exponent < 0, node.base in rooted

    def step(call: _Call) -> Expr:
        value, graph = base(call), call.graph
        if negative and root:
            return _repeated(graph, graph.one / graph.sqrt(value), halves)
        result = _repeated(graph, value, halves // 2)
        if halves % 2:
            result = result * graph.sqrt(value)
        return graph.one / result if negative else result

    return step


def _repeated(graph: Graph, value: Expr, power: int) -> Expr:
    """value to that power by squaring."""
    result = graph.one
    while power:
        if power & 1:
            result = result * value
        value = value * value
        power >>= 1
    return result


def _piecewise(node: sp.Piecewise, convert: _Convert) -> _Step:
    *cases, (last, _) = node.args
    otherwise, choices = convert(last), []
    for value, condition in reversed(cases):
        if not isinstance(condition, sp.StrictGreaterThan | sp.StrictLessThan | sp.Ge | sp.Le):
            raise TypeError(f"condition {condition} has no counterpart in generated code")
        strict = isinstance(condition, sp.StrictGreaterThan | sp.StrictLessThan)
        choices.append((convert(condition.gts), convert(condition.lts), convert(value), strict))

    def step(call: _Call) -> Expr:
        result = otherwise(call)
        for greater, less, value, strict in choices:
            difference = greater(call) - less(call)
            if strict:
                result = call.graph.call("select", difference, value(call), result)
            else:
                result = call.graph.call("select", -difference, result, value(call))
        return result

    return step
