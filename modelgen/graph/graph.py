"""The expression graph: every value has one node, negation is a bit in the reference.

A reference ("key") is twice the node's index plus one where the value is negated. `a - b` and
`b - a` are thus one node, and a negation costs nothing until a program is printed. Constants are
folded and 0 and 1 disappear while nodes are made, so no pass has to clean up afterwards.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TypeAlias

Number: TypeAlias = int | float

CONST, INPUT, ADD, MUL, DIV, CALL = range(6)

ODD = frozenset({"sin", "tan", "asin", "atan", "tanh", "sign"})
EVEN = frozenset({"cos", "abs"})
UNARY: dict[str, Callable[[float], float]] = {
    "sin": math.sin,
    "cos": math.cos,
    "tan": math.tan,
    "asin": math.asin,
    "acos": math.acos,
    "atan": math.atan,
    "sqrt": math.sqrt,
    "exp": math.exp,
    "log": math.log,
    "tanh": math.tanh,
    "abs": abs,
    "sign": lambda x: float((x > 0) - (x < 0)),
}
BINARY: dict[str, Callable[[float, float], float]] = {
    "atan2": math.atan2,
    "pow": math.pow,
    "min": min,
    "max": max,
}
# select(c, a, b) is a where c > 0, else b
FUNCTIONS = frozenset(UNARY) | frozenset(BINARY) | {"select"}


class Expr:
    """A value in a graph, with Python's arithmetic."""

    __slots__ = ("graph", "key")

    def __init__(self, graph: Graph, key: int) -> None:
        self.graph = graph
        self.key = key

    def __add__(self, other: Expr | Number) -> Expr:
        graph = self.graph
        key = other.key if isinstance(other, Expr) else graph.key(other)
        return Expr(graph, graph.add(self.key, key))

    def __sub__(self, other: Expr | Number) -> Expr:
        graph = self.graph
        key = other.key if isinstance(other, Expr) else graph.key(other)
        return Expr(graph, graph.add(self.key, key ^ 1))

    def __rsub__(self, other: Number) -> Expr:
        graph = self.graph
        return Expr(graph, graph.add(graph.key(other), self.key ^ 1))

    def __mul__(self, other: Expr | Number) -> Expr:
        graph = self.graph
        key = other.key if isinstance(other, Expr) else graph.key(other)
        return Expr(graph, graph.mul(self.key, key))

    def __truediv__(self, other: Expr | Number) -> Expr:
        graph = self.graph
        return Expr(graph, graph.div(self.key, graph.key(other)))

    def __rtruediv__(self, other: Number) -> Expr:
        graph = self.graph
        return Expr(graph, graph.div(graph.key(other), self.key))

    def __neg__(self) -> Expr:
        return Expr(self.graph, self.key ^ 1)

    __radd__ = __add__
    __rmul__ = __mul__

    @property
    def value(self) -> float | None:
        """The number that this expression is, None where it is not constant."""
        return self.graph.constant(self.key)

    @property
    def is_zero(self) -> bool:
        """Whether this is the constant 0."""
        return self.key <= 1


class Graph:
    """The nodes of one or several functions that share their sub-expressions.

    `notes` says of each node what it is a part of, as far as that was said when it was made: see `noted`.
    """

    def __init__(self) -> None:
        self.op: list[int] = []
        self.args: list[tuple[int, ...]] = []
        self.name: list[str] = []  # input: its vector's name; call: the function
        self.number: list[float] = []  # constant: magnitude; input: index
        self.notes: list[str] = []
        self._note = ""
        self._ids: dict[object, int] = {}
        self.zero = Expr(self, self._node((CONST, 0.0), CONST, number=0.0))
        self.one = Expr(self, self._node((CONST, 1.0), CONST, number=1.0))

    def __len__(self) -> int:
        return len(self.op)

    def _node(
        self, identity: object, op: int, args: tuple[int, ...] = (), name: str = "", number: float = 0.0
    ) -> int:
        found = self._ids.get(identity)
        if found is None:
            found = len(self.op)
            self._ids[identity] = found
            self.op.append(op)
            self.args.append(args)
            self.name.append(name)
            self.number.append(number)
            self.notes.append(self._note)
        return 2 * found

    @contextmanager
    def noted(self, text: str) -> Iterator[None]:
        """Nodes made meanwhile are a part of this: a link and a pass over the links, say."""
        before, self._note = self._note, text
        try:
            yield
        finally:
            self._note = before

    # -- leaves ---------------------------------------------------------------------------

    def const(self, value: Number) -> Expr:
        """The constant `value`; raises ValueError where it is not finite."""
        return Expr(self, self._const(value))

    def input(self, name: str, index: int) -> Expr:
        """Element `index` of the input vector `name`."""
        return Expr(self, self._node((INPUT, name, index), INPUT, name=name, number=index))

    def key(self, value: Expr | Number) -> int:
        """The reference of an expression or a number."""
        return value.key if isinstance(value, Expr) else self._const(value)

    def constant(self, key: int) -> float | None:
        """The value of a constant's reference, else None."""
        return self._number(key) if self.op[key >> 1] == CONST else None

    def _number(self, key: int) -> float:
        """The value of a reference to a constant."""
        number = self.number[key >> 1]
        return -number if key & 1 else number

    def _const(self, value: Number) -> int:
        value = float(value)
        if not math.isfinite(value):
            raise ValueError(f"a constant of the model is {value}")
        magnitude = abs(value)
        return self._node((CONST, magnitude), CONST, number=magnitude) | (value < 0)

    # -- operations on references ---------------------------------------------------------

    def _factored(self, key: int) -> tuple[float, int]:
        """A reference as coefficient times a positive reference."""
        sign = -1.0 if key & 1 else 1.0
        node = key >> 1
        if self.op[node] == MUL:
            left, right = self.args[node]
            if self.op[left >> 1] == CONST:
                return sign * self._number(left), right
        return sign, key & ~1

    def common_factor(self, x: Expr, y: Expr) -> tuple[Expr, Expr, Expr] | None:
        """(f, u, v) with x = f u and y = f v for a factor f that is no constant, else None."""
        a, b = x.key >> 1, y.key >> 1
        if self.op[a] != MUL or self.op[b] != MUL or a == b:
            return None
        for f, u in (self.args[a], self.args[a][::-1]):
            for h, v in (self.args[b], self.args[b][::-1]):
                if f == h and self.op[f >> 1] != CONST:
                    return Expr(self, f), Expr(self, u | (x.key & 1)), Expr(self, v | (y.key & 1))
        return None

    def add(self, x: int, y: int) -> int:
        """x + y."""
        if x <= 1:
            return y
        if y <= 1:
            return x
        if x == y ^ 1:
            return 0
        op, args = self.op, self.args
        i, j = x >> 1, y >> 1
        if i > j:
            x, y, i, j = y, x, j, i
        number = op[i] == CONST
        if number and op[j] == CONST:
            return self._const(self._number(x) + self._number(y))
        # (u + v) - v and constants met again in a sum
        for inner, other in ((x, y), (y, x)):
            if op[inner >> 1] == ADD:
                u, v = args[inner >> 1]
                u, v = u ^ (inner & 1), v ^ (inner & 1)
                if other == u ^ 1:
                    return v
                if other == v ^ 1:
                    return u
                if op[other >> 1] == CONST and op[u >> 1] == CONST:
                    return self.add(self._const(self._number(u) + self._number(other)), v)
        if not number:
            cx, ux = self._factored(x)
            cy, uy = self._factored(y)
            if ux == uy:
                return self.mul(self._const(cx + cy), ux)
        if x & 1:
            return self._node((ADD, x ^ 1, y ^ 1), ADD, (x ^ 1, y ^ 1)) ^ 1
        return self._node((ADD, x, y), ADD, (x, y))

    def mul(self, x: int, y: int) -> int:
        """x y."""
        if x <= 1 or y <= 1:
            return 0
        sign = (x ^ y) & 1
        x &= ~1
        y &= ~1
        if x == 2:
            return y | sign
        if y == 2:
            return x | sign
        op = self.op
        if op[y >> 1] == CONST or (op[x >> 1] != CONST and x > y):
            x, y = y, x
        if op[x >> 1] == CONST:
            a, of_y = self.number[x >> 1], op[y >> 1]
            if of_y == CONST:
                return self._const(a * self.number[y >> 1]) ^ sign
            if of_y == MUL:
                left, right = self.args[y >> 1]
                if op[left >> 1] == CONST:
                    return self.mul(self._const(a * self.number[left >> 1]), right) ^ sign
        return self._node((MUL, x, y), MUL, (x, y)) | sign

    def div(self, x: int, y: int) -> int:
        """x / y; a division by a constant becomes a multiplication."""
        if x <= 1:
            return 0
        value = self.constant(y)
        if value is not None:
            if value == 0.0:
                raise ZeroDivisionError("the model divides by a constant zero")
            return self.mul(x, self._const(1.0 / value))
        sign = (x ^ y) & 1
        x &= ~1
        y &= ~1
        if x == y:
            return 2 | sign
        return self._node((DIV, x, y), DIV, (x, y)) | sign

    def call(self, name: str, *arguments: Expr | Number) -> Expr:
        """One of FUNCTIONS of the arguments; odd and even functions absorb the sign."""
        keys = tuple(self.key(a) for a in arguments)
        values = [self.constant(k) for k in keys]
        numbers = [v for v in values if v is not None]
        if len(numbers) == len(values) and name != "select":
            return self.const(UNARY[name](numbers[0]) if name in UNARY else BINARY[name](*numbers))
        if name == "select" and values[0] is not None:
            return Expr(self, keys[1] if values[0] > 0 else keys[2])
        sign = 0
        if name == "sign":  # of a product with a constant: of the other factor
            factor, rest = self._factored(keys[0])
            keys = (rest | (factor < 0),)
        if name in ODD:
            sign = keys[0] & 1
            keys = (keys[0] & ~1,)
        elif name in EVEN:
            keys = (keys[0] & ~1,)
        return Expr(self, self._node((CALL, name, keys), CALL, keys, name=name) | sign)

    def again(self, op: int, name: str, operands: Sequence[Expr]) -> Expr:
        """What an operation of any graph makes of these operands; name: of the function of a call."""
        if op == ADD:
            return operands[0] + operands[1]
        if op == MUL:
            return operands[0] * operands[1]
        if op == DIV:
            return operands[0] / operands[1]
        return self.call(name, *operands)

    def sqrt(self, x: Expr) -> Expr:
        """Square root of x."""
        return self.call("sqrt", x)
