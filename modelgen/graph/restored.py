"""Programs read back into a graph, where those of several functions share what they have in common."""

from __future__ import annotations

from modelgen.graph.graph import Expr, Graph
from modelgen.graph.lowering import Program, Term


def restored(graph: Graph, program: Program) -> tuple[dict[tuple[str, int], Expr], list[tuple[Expr, int]]]:
    """Elements of outputs that the program sets; what its guards want positive, with their bits."""
    named: dict[int, Expr] = {}
    outputs: dict[tuple[str, int], Expr] = {}
    guards: list[tuple[Expr, int]] = []

    def value(term: Term) -> Expr:
        tag, *parts = term
        if tag == "const":
            return graph.const(parts[0])
        if tag == "in":
            return graph.input(parts[0], parts[1])
        if tag == "let":
            return named[parts[0]]
        if tag == "call":
            return graph.call(parts[0], *map(value, parts[1:]))
        if tag == "neg":
            return -value(parts[0])
        left, right = map(value, parts)
        if tag == "add":
            return left + right
        if tag == "sub":
            return left - right
        return left * right if tag == "mul" else left / right

    for statement in program.statements:
        found, target = value(statement.term), statement.target
        if isinstance(target, int):
            named[target] = found
        elif target[0] == "guard":
            guards.append((found, target[1]))
        else:
            outputs[target] = found
    return outputs, guards
