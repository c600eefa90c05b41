"""Inputs of a graph's values replaced by other values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from modelgen.graph.graph import INPUT, Expr
from modelgen.graph.lowering import reachable


def substituted(values: Sequence[Expr], given: Mapping[tuple[str, int], Expr]) -> list[Expr]:
    """The values with the elements (input vector, element) of `given` replaced, in the same graph."""
    if not values:
        return []
    graph = values[0].graph
    changed: dict[int, Expr] = {}

    def now(key: int) -> Expr:
        found = changed.get(key >> 1)
        if found is None:
            return Expr(graph, key)
        return -found if key & 1 else found

    for node in reachable(graph, [e.key for e in values]):
        op, keys = graph.op[node], graph.args[node]
        if op == INPUT:
            found = given.get((graph.name[node], int(graph.number[node])))
            if found is not None:
                changed[node] = found
        elif any(key >> 1 in changed for key in keys):
            changed[node] = graph.again(op, graph.name[node], [now(key) for key in keys])
    return [now(e.key) for e in values]
