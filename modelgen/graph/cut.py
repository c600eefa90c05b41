"""An expression cut in two: what does not depend on some inputs, and the rest."""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.graph.graph import CONST, INPUT, Expr, Graph
from modelgen.graph.lowering import reachable

PLAIN = (0.0, 0.5, 1.0, 2.0)  # constants that stay in the rest


def cut(expressions: Sequence[Expr], inputs: Sequence[str], name: str) -> tuple[list[Expr], list[Expr]]:
    """(heads, tails): `expressions` again are `tails`, over `inputs` and an input `name` with the `heads`.

    Heads are the largest sub-expressions that depend on none of the inputs, and all constants but small
    round ones, so that the tails of one law are the same whatever the figures are. The tails lie in a graph
    of their own.
    """
    graph, rest = expressions[0].graph, Graph()
    roots = [e.key for e in expressions]
    nodes = reachable(graph, roots)
    depends: dict[int, bool] = {}
    for node in nodes:
        own = graph.op[node] == INPUT and graph.name[node] in inputs
        depends[node] = own or any(depends[key >> 1] for key in graph.args[node])
    places: dict[int, Expr] = {}
    heads: list[Expr] = []

    def tail(key: int) -> Expr:
        node = key >> 1
        if node not in places:
            if graph.op[node] == CONST and graph.number[node] in PLAIN:
                places[node] = rest.const(graph.number[node])
            else:
                places[node] = rest.input(name, len(heads))
                heads.append(Expr(graph, 2 * node))
        return -places[node] if key & 1 else places[node]

    for node in nodes:
        if not depends[node]:
            continue
        op, operands = graph.op[node], [tail(key) for key in graph.args[node]]
        if op == INPUT:
            places[node] = rest.input(graph.name[node], int(graph.number[node]))
        else:
            places[node] = rest.again(op, graph.name[node], operands)
    tails = [tail(key) for key in roots]
    return heads, tails
