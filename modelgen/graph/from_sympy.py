"""Expressions of SymPy, in which transmissions and effects are written, become nodes of the graph."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping

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
    cache: dict[sp.Basic, Expr] = {}
    expression = sp.sympify(expression)
    # What stands under a root is divided by through one reciprocal root: divisions are dear.
    rooted = {power.base for power in expression.atoms(sp.Pow) if _halves(power.exp) and 2 * power.exp % 2}

    def convert(node: sp.Basic) -> Expr:
        if node not in cache:
            cache[node] = build(node)
        return cache[node]

    def build(node: sp.Basic) -> Expr:
        if isinstance(node, sp.Symbol):
            return bindings[node]
        if node.is_number:
            return graph.const(float(node))
        if isinstance(node, sp.Add):
            return _sum([convert(a) for a in node.args])
        if isinstance(node, sp.Mul):
            return _product(graph, node, convert, rooted)
        if isinstance(node, sp.Pow):
            return _power(graph, node, convert, rooted)
        if isinstance(node, sp.sin | sp.cos) and trigonometry:
            known = trigonometry(node.args[0])
            if known:
                return known[0 if isinstance(node, sp.sin) else 1]
        if isinstance(node, sp.Piecewise):
            return _piecewise(graph, node, convert)
        name = _CALLS.get(type(node))
        if name is None:
            raise TypeError(f"{type(node).__name__} has no counterpart in generated code")
        arguments = [convert(a) for a in node.args]
        if name in ("max", "min"):
            result = arguments[0]
            for argument in arguments[1:]:
                result = graph.call(name, result, argument)
            return result
        return graph.call(name, *arguments)

    return convert(expression)


def _halves(exponent: sp.Expr) -> bool:
    """Whether the exponent is a small multiple of one half."""
    return bool(exponent.is_number and (2 * exponent).is_integer and abs(2 * exponent) <= 16)


def _sum(terms: list[Expr]) -> Expr:
    total = terms[0]
    for term in terms[1:]:
        total = total + term
    return total


def _product(
    graph: Graph, node: sp.Mul, convert: Callable[[sp.Basic], Expr], rooted: Collection[sp.Expr]
) -> Expr:
    """Numerator over denominator, so that a product has at most one division."""
    over, under = graph.one, graph.one
    for factor in node.args:
        negative = isinstance(factor, sp.Pow) and factor.exp.is_number and factor.exp < 0
        if negative and factor.base not in rooted:
            under = under * convert(sp.Pow(factor.base, -factor.exp))
        else:
            over = over * convert(factor)
    return over / under


def _power(
    graph: Graph, node: sp.Pow, convert: Callable[[sp.Basic], Expr], rooted: Collection[sp.Expr]
) -> Expr:
    base, exponent = node.base, node.exp
    if not _halves(exponent):
        return graph.call("pow", convert(base), convert(exponent))
    value, count = convert(base), abs(int(2 * exponent))
    if exponent < 0 and base in rooted:
        inverse = graph.one / graph.sqrt(value)
        return _repeated(graph, inverse, count)
    result = _repeated(graph, value, count // 2)
    if count % 2:
        result = result * graph.sqrt(value)
    return graph.one / result if exponent < 0 else result


def _repeated(graph: Graph, value: Expr, count: int) -> Expr:
    """value to the power `count` by squaring."""
    result = graph.one
    while count:
        if count & 1:
            result = result * value
        value = value * value
        count >>= 1
    return result


def _piecewise(graph: Graph, node: sp.Piecewise, convert: Callable[[sp.Basic], Expr]) -> Expr:
    *cases, (last, _) = node.args
    result = convert(last)
    for value, condition in reversed(cases):
        if not isinstance(condition, sp.StrictGreaterThan | sp.StrictLessThan | sp.Ge | sp.Le):
            raise TypeError(f"condition {condition} has no counterpart in generated code")
        difference = convert(condition.gts) - convert(condition.lts)
        if isinstance(condition, sp.StrictGreaterThan | sp.StrictLessThan):
            result = graph.call("select", difference, convert(value), result)
        else:
            result = graph.call("select", -difference, result, convert(value))
    return result
