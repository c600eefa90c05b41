"""Derivatives of a graph's values, by forward tangents in the same graph (Griewank and Walther 2008).

Value numbering shares what several directions and the values themselves have in common. At a kink of a law
the derivative is the mean of those on both sides; an infinite slope counts as none.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from modelgen.graph.graph import ADD, CALL, CONST, DIV, INPUT, MUL, Expr, Graph
from modelgen.graph.lowering import reachable

Direction = Mapping[tuple[str, int], Expr]  # (input vector, element) -> its rate; others stand still


def tangents(values: Sequence[Expr], directions: Sequence[Direction]) -> list[list[Expr]]:
    """Derivatives of `values` along each direction: one list for each direction, of len(values).

    A direction gives the rates of input elements. Signs squared count as 1, as they are on both sides of
    their zero. Raises ValueError for a call that has no derivative here.
    """
    if not values:
        return [[] for _ in directions]
    graph = values[0].graph
    nodes = reachable(graph, [e.key for e in values])
    divisors = frozenset(graph.args[n][1] >> 1 for n in nodes if graph.op[n] == DIV)
    return [_Tangent(graph, nodes, divisors, direction).of(values) for direction in directions]


@dataclass(frozen=True)
class _Tangent:
    """The derivative along one direction. divisors: nodes that the values divide by, so none vanishes."""

    graph: Graph
    nodes: Sequence[int]
    divisors: frozenset[int]
    direction: Direction

    def of(self, values: Sequence[Expr]) -> list[Expr]:
        graph, zero = self.graph, self.graph.zero
        rates: dict[int, Expr] = {}  # of nodes that change
        for node in self.nodes:
            op = graph.op[node]
            if op == CONST:
                continue
            if op == INPUT:
                rate = self.direction.get((graph.name[node], int(graph.number[node])), zero)
            else:
                keys = graph.args[node]
                if all(key >> 1 not in rates for key in keys):
                    continue
                operands = [Expr(graph, key) for key in keys]
                changes = [_signed(rates.get(key >> 1, zero), key) for key in keys]
                rate = self._rate(node, operands, changes)
            if not rate.is_zero:
                rates[node] = rate
        return [_signed(rates.get(e.key >> 1, zero), e.key) for e in values]

    def _rate(self, node: int, x: Sequence[Expr], dx: Sequence[Expr]) -> Expr:
        graph = self.graph
        op = graph.op[node]
        if op == ADD:
            return dx[0] + dx[1]
        if op == MUL:
            return _product(dx[0], x[1]) + _product(dx[1], x[0])
        value = Expr(graph, 2 * node)
        if op == DIV:
            return _quotient(value, x, dx)
        assert op == CALL
        name = graph.name[node]
        if name in _SEVERAL:
            return _SEVERAL[name](value, x, dx)
        slope = self._root(value) if name == "sqrt" else _slope(name, value, x[0])
        return _product(dx[0], slope)

    def _root(self, value: Expr) -> Expr:
        """Slope of a root; one that may vanish is that of a size, which is then least or at its bound."""
        if value.key >> 1 not in self.divisors:
            value = _or_one(value)
        return (1.0 / value) * 0.5


def _signed(e: Expr, key: int) -> Expr:
    return -e if key & 1 else e


def _or_one(e: Expr) -> Expr:
    """A value that is not negative, 1 where it is zero."""
    return e.graph.call("select", e, e, 1.0)


def _quotient(value: Expr, x: Sequence[Expr], dx: Sequence[Expr]) -> Expr:
    """(dx - value dy) / y by the reciprocal that the values may have already."""
    inverse = 1.0 / x[1]
    return _product(dx[0] - _product(dx[1], value), inverse)


def _slope(name: str, value: Expr, x: Expr) -> Expr:
    """Derivative of a function of one argument."""
    graph = x.graph
    if name == "sin":
        return graph.call("cos", x)
    if name == "cos":
        return -graph.call("sin", x)
    if name == "tan":
        return value * value + 1.0
    if name in ("asin", "acos"):
        slope = 1.0 / _or_one(graph.sqrt(graph.call("max", 1.0 - x * x, 0.0)))
        return slope if name == "asin" else -slope
    if name == "atan":
        return 1.0 / (x * x + 1.0)
    if name == "exp":
        return value
    if name == "log":
        return 1.0 / x
    if name == "tanh":
        return 1.0 - value * value
    if name == "abs":
        return graph.call("sign", x)
    if name == "sign":
        return graph.zero
    raise ValueError(f"{name} has no derivative here")


# -- functions of several arguments -------------------------------------------------------------


def _atan2(value: Expr, x: Sequence[Expr], dx: Sequence[Expr]) -> Expr:
    size = x[0] * x[0] + x[1] * x[1]
    return (_product(dx[0], x[1]) - _product(dx[1], x[0])) / _or_one(size)


def _power(value: Expr, x: Sequence[Expr], dx: Sequence[Expr]) -> Expr:
    graph, (base, exponent) = value.graph, x
    known = exponent.value
    if known is None:
        slope = exponent * graph.call("pow", base, exponent - 1.0)
        rate = _product(dx[0], slope)
        return rate if dx[1].is_zero else rate + dx[1] * (value * graph.call("log", base))
    less = known - 1.0
    if less < 0.0:  # an infinite slope at zero: none
        lower = graph.call("select", base, graph.call("pow", _or_one(base), less), 0.0)
    else:
        lower = graph.one if less == 0.0 else base if less == 1.0 else graph.call("pow", base, less)
    return _product(dx[0], lower * known)


def _larger(value: Expr, x: Sequence[Expr], dx: Sequence[Expr]) -> Expr:
    return _either(x[0] - x[1], dx)


def _smaller(value: Expr, x: Sequence[Expr], dx: Sequence[Expr]) -> Expr:
    return _either(x[1] - x[0], dx)


def _either(which: Expr, dx: Sequence[Expr]) -> Expr:
    """The first rate where `which` is positive, the other where it is negative, else their mean."""
    half = which.graph.call("sign", which) * 0.5
    return dx[0] * (half + 0.5) + dx[1] * (0.5 - half)


def _chosen(value: Expr, x: Sequence[Expr], dx: Sequence[Expr]) -> Expr:
    """As `_either`, for branches of which the one not taken may have no value."""
    select = value.graph.call
    if dx[1].key == dx[2].key:
        return dx[1]
    return select("select", x[0], dx[1], select("select", -x[0], dx[2], (dx[1] + dx[2]) * 0.5))


_SEVERAL: Mapping[str, Callable[[Expr, Sequence[Expr], Sequence[Expr]], Expr]] = {
    "atan2": _atan2,
    "pow": _power,
    "max": _larger,
    "min": _smaller,
    "select": _chosen,
}


# -- products in which a sign meets itself ------------------------------------------------------


def _product(rate: Expr, by: Expr) -> Expr:
    """rate times by, sign(x) sign(x) in it as 1: so it is on both sides of x = 0, and the mean of what is odd
    is none.
    """
    if rate.is_zero or by.is_zero:
        return rate.graph.zero
    for sign in _signs(by):
        rest = _without(rate, sign)
        if rest is not None:
            other = _without(by, sign)
            assert other is not None
            return _product(rest, other)
        graph, node = rate.graph, rate.key >> 1
        if graph.op[node] == ADD:
            terms = [Expr(graph, key ^ (rate.key & 1)) for key in graph.args[node]]
            if any(_without(term, sign) is not None for term in terms):
                return _product(terms[0], by) + _product(terms[1], by)
    return rate * by


def _signs(e: Expr) -> list[int]:
    """Nodes of the signs among the factors of a value."""
    graph = e.graph
    found, stack = [], [e.key >> 1]
    while stack:
        node = stack.pop()
        if graph.op[node] == MUL:
            stack.extend(key >> 1 for key in graph.args[node])
        elif graph.op[node] == CALL and graph.name[node] == "sign":
            found.append(node)
    return found


def _without(e: Expr, sign: int) -> Expr | None:
    """The value without a factor, None where it does not have it."""
    graph, node = e.graph, e.key >> 1
    if node == sign:
        return _signed(graph.one, e.key)
    if graph.op[node] == MUL:
        left, right = (Expr(graph, key) for key in graph.args[node])
        for one, other in ((left, right), (right, left)):
            rest = _without(one, sign)
            if rest is not None:
                return _signed(rest * other, e.key)
    return None
