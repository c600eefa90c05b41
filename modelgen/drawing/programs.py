"""Functions of a joint's coordinate as data that a page evaluates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

import sympy as sp

from modelgen.graph import Expr, Graph
from modelgen.graph.from_sympy import from_sympy
from modelgen.graph.graph import ADD, CONST, DIV, INPUT, MUL
from modelgen.graph.lowering import reachable
from modelgen.symbolic import geometry_symbol

Program: TypeAlias = dict[str, list[Any]]

_NAMES = {ADD: "add", MUL: "mul", DIV: "div"}


def program(expressions: Sequence[sp.Expr], q: sp.Symbol, symbols: Mapping[str, float]) -> Program:
    """Steps and results of a straight-line program over `q`.

    A step is a number, "q", or a name of `graph.graph.FUNCTIONS`, "add", "mul" or "div" with the steps that
    it works on. A reference k below zero is minus the step -1 - k. symbols: values of the arm's named
    geometry.
    Raises TypeError for a function that generated code has not.
    """
    graph = Graph()
    bindings = {geometry_symbol(name): graph.const(value) for name, value in symbols.items()}
    bindings[q] = graph.input("q", 0)
    return _steps(graph, [from_sympy(graph, e, bindings) for e in expressions])


def _steps(graph: Graph, roots: Sequence[Expr]) -> Program:
    steps: list[Any] = []
    number: dict[int, int] = {}

    def reference(key: int) -> int:
        k = number[key >> 1]
        return -1 - k if key & 1 else k

    for node in reachable(graph, [root.key for root in roots]):
        op, operands = graph.op[node], [reference(key) for key in graph.args[node]]
        if op == CONST:
            steps.append(graph.number[node])
        elif op == INPUT:
            steps.append("q")
        else:
            steps.append([_NAMES.get(op, graph.name[node]), *operands])
        number[node] = len(steps) - 1
    return {"steps": steps, "results": [reference(root.key) for root in roots]}
