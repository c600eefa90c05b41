"""Geometry values in the graph: constants, or elements of a run-time geometry vector."""

from __future__ import annotations

import math

import sympy as sp

from modelgen.description.objects import Arm, Scalar, geometry_symbol
from modelgen.graph import Expr, Graph
from modelgen.graph.from_sympy import from_sympy

SNAP = 1e-12  # sines and cosines this close to 0 or 1 are meant to be 0 or 1


def snapped(value: float) -> float:
    """`value`, with what is within 1e-12 of 0 or of +-1 made exact."""
    nearest = round(value)
    return float(nearest) if abs(value - nearest) < SNAP else value


class Scalars:
    """Turns numbers and symbolic geometry of one arm into expressions.

    With `runtime` the arm's symbols are inputs `geometry[k]` in the order of `arm.symbols`,
    otherwise their values are folded in.
    """

    def __init__(self, graph: Graph, arm: Arm, runtime: bool = False) -> None:
        self.graph = graph
        self.symbols = {
            geometry_symbol(name): graph.input("geometry", k) if runtime else graph.const(value)
            for k, (name, value) in enumerate(arm.symbols.items())
        }

    def __call__(self, value: Scalar) -> Expr:
        """The value as an expression."""
        if isinstance(value, sp.Expr):
            return from_sympy(self.graph, value, self.symbols)
        return self.graph.const(value)

    def sin_cos(self, angle: Scalar) -> tuple[Expr, Expr]:
        """Sine and cosine of a constant angle, exact at multiples of a right angle."""
        value = self(angle)
        if value.value is None:
            return self.graph.call("sin", value), self.graph.call("cos", value)
        return (
            self.graph.const(snapped(math.sin(value.value))),
            self.graph.const(snapped(math.cos(value.value))),
        )
