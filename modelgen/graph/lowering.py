"""A graph becomes a straight-line program: order, signs, and which values get a name.

The program is what every backend prints, so the operations that it counts are those that run.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

from modelgen.graph.graph import ADD, CALL, CONST, DIV, EVEN, INPUT, MUL, ODD, Expr, Graph
from modelgen.graph.polarity import choose_polarity

# ("const", value) ("in", vector, index) ("let", number) ("neg", t) ("add"|"sub"|"mul"|"div", t, t)
# ("call", function, t, ...)
Term: TypeAlias = tuple[Any, ...]

LEAVES = frozenset({"const", "in", "let"})
BINARY = frozenset({ADD, MUL, DIV})
INLINE_SIZE = 6  # leaves of an expression printed on one line


@dataclass(frozen=True, repr=False)
class Statement:
    """`target` is a temporary's number, (output name, element), or ("guard", bit).

    `term` is the value. A guard says that the value must be positive for what follows to make sense;
    `bit` is the status to report where it is not. note: what it is a part of (see `Graph.noted`).
    """

    target: int | tuple[str, int]
    term: Term
    note: str = field(default="", compare=False)

    def __repr__(self) -> str:
        """As a dataclass has it, without the note."""
        return f"Statement(target={self.target!r}, term={self.term!r})"


def read(term: Term) -> list[int]:
    """Numbers of the temporaries in a term, from the left."""
    return [number for tag, number, *_ in _leaves(term) if tag == "let"]


def inputs(term: Term) -> list[tuple[str, int]]:
    """Elements of inputs in a term, from the left."""
    return [(leaf[1], leaf[2]) for leaf in _leaves(term) if leaf[0] == "in"]


def _leaves(term: Term) -> list[Term]:
    found = []
    stack = [term]
    while stack:
        term = stack.pop()
        if term[0] in LEAVES:
            found.append(term)
        else:
            stack += term[: 1 if term[0] == "call" else 0 : -1]
    return found


@dataclass(frozen=True)
class Program:
    """Statements in order of execution. Outputs that are constant zero are not among them."""

    statements: tuple[Statement, ...]
    temporaries: int


def reachable(graph: Graph, roots: Sequence[int]) -> list[int]:
    """Nodes that the references in `roots` need, operands before results (by construction: by index)."""
    args = graph.args
    seen = {key >> 1 for key in roots}
    stack = list(seen)
    while stack:
        for key in args[stack.pop()]:
            node = key >> 1
            if node not in seen:
                seen.add(node)
                stack.append(node)
    return sorted(seen)


def _registers(graph: Graph, nodes: Sequence[int]) -> dict[int, int]:
    """How many registers each node takes if nothing is shared (Sethi, Ullman, 1970); `nodes` by index."""
    count: dict[int, int] = {}
    for node in nodes:
        keys = graph.args[node]
        if graph.op[node] in BINARY:
            x, y = count[keys[0] >> 1], count[keys[1] >> 1]
            count[node] = x + 1 if x == y else max(x, y)
        else:
            operands = sorted((count[key >> 1] for key in keys), reverse=True)
            count[node] = max((needed + kept for kept, needed in enumerate(operands)), default=1)
    return count


class _Lowering:
    def __init__(self, graph: Graph, roots: Sequence[int], guards: Mapping[int, tuple[int, int]]) -> None:
        self.graph = graph
        self.guards = guards  # node -> (reference that must be positive, status bit)
        nodes = reachable(graph, roots)
        self.polarity = choose_polarity(graph, nodes, roots)
        self.uses: dict[int, int] = dict.fromkeys(nodes, 0)
        uses, args = self.uses, graph.args
        for node in nodes:
            for key in args[node]:
                uses[key >> 1] += 1
        for key in roots:
            uses[key >> 1] += 1
        self.registers = _registers(graph, nodes)
        self.number: dict[int, int] = {}
        self.terms: dict[int, tuple[Term, int]] = {}
        self.statements: list[Statement] = []

    def visit(self, root: int) -> None:
        """Emit what the reference `root` needs, operands first, without recursion."""
        stack = [(root >> 1, False)]
        while stack:
            node, ready = stack.pop()
            if node in self.terms:
                continue
            if not ready:
                stack.append((node, True))
                operands = [key >> 1 for key in reversed(self.graph.args[node])]
                operands.sort(key=self.registers.__getitem__)
                stack += [(operand, False) for operand in operands if operand not in self.terms]
                continue
            term, size = self._term(node)
            op = self.graph.op[node]
            named = op not in (CONST, INPUT) and (
                self.uses[node] > 1 or size > INLINE_SIZE or op in (DIV, CALL) or node in self.guards
            )
            if named:
                self.number[node] = len(self.number)
                self.statements.append(Statement(self.number[node], term, self.graph.notes[node]))
                term, size = ("let", self.number[node]), 1
            self.terms[node] = (term, size)
            if node in self.guards:
                key, bit = self.guards[node]
                self.statements.append(Statement(("guard", bit), self.signed(key)))

    def signed(self, key: int) -> Term:
        """The term of a reference, negated where the program computes its negative."""
        term, _, negative = self.operand(key)
        if not negative:
            return term
        return ("const", -term[1]) if term[0] == "const" else ("neg", term)

    def operand(self, key: int) -> tuple[Term, int, bool]:
        """The term of a reference, its size, and whether the reference is its negative."""
        term, size = self.terms[key >> 1]
        return term, size, bool((key & 1) ^ self.polarity[key >> 1])

    def _term(self, node: int) -> tuple[Term, int]:
        graph = self.graph
        op, args = graph.op[node], graph.args[node]
        if op == CONST:
            return ("const", graph.number[node]), 1
        if op == INPUT:
            return ("in", graph.name[node], int(graph.number[node])), 1
        operands = [self.operand(key) for key in args]
        size = sum(s for _, s, _ in operands)
        if op == CALL:
            odd_or_even = graph.name[node] in ODD | EVEN
            terms = [("neg", t) if n and not odd_or_even else t for t, _, n in operands]
            return ("call", graph.name[node], *terms), size
        negated = bool(self.polarity[node])
        (a, _, na), (b, _, nb) = operands
        if op == ADD:
            na, nb = na ^ negated, nb ^ negated
            if a[0] == "const":
                value = -a[1] if na else a[1]
                if nb:
                    return ("sub", ("const", value), b), size
                return (("add", b, ("const", value)) if value >= 0 else ("sub", b, ("const", -value))), size
            if na:
                return (("sub", b, a) if not nb else ("neg", ("add", a, b))), size
            return ("sub" if nb else "add", a, b), size
        if a[0] == "const":
            a = ("const", -a[1] if na ^ nb ^ negated else a[1])
        return ("mul" if op == MUL else "div", a, b), size


def lower(
    outputs: Mapping[str, Sequence[Expr]],
    guards: Sequence[tuple[Expr, int]] = (),
    order: Sequence[tuple[str, int]] | None = None,
) -> Program:
    """The program that computes `outputs`; constant zeros are left out.

    `guards` are values that must be positive, with the status bit to report where one is not. They are
    computed before all else, so that a bad state is left early and fewer values are alive later; each is
    tested as soon as it is known, before anything is divided by it. `order` lists (output, element) in the
    order of computation, by default that of `outputs`; of two operands the one that takes more registers
    comes first.
    A value used once is written where it is used, as long as the line stays readable. Each output
    follows at once on what it needs, which keeps few values alive.
    """
    places = order or [(name, i) for name, vector in outputs.items() for i in range(len(vector))]
    flat = [(name, i, outputs[name][i]) for name, i in places if not outputs[name][i].is_zero]
    if not flat:
        return Program((), 0)
    tested = {e.key >> 1: (e.key, bit) for e, bit in guards if e.value is None}
    roots = [e.key for _, _, e in flat] + [key for key, _ in tested.values()]
    lowering = _Lowering(flat[0][2].graph, roots, tested)
    for node in sorted(tested):  # whether or not an output leads to it
        lowering.visit(tested[node][0])
    for name, i, expression in flat:
        lowering.visit(expression.key)
        lowering.statements.append(Statement((name, i), lowering.signed(expression.key)))
    return Program(tuple(lowering.statements), len(lowering.number))
