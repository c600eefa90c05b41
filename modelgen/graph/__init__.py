"""A value-numbered expression graph and the straight-line programs made from it."""

from modelgen.graph.cut import cut
from modelgen.graph.graph import Expr, Graph, Number
from modelgen.graph.lowering import Program, Statement, Term, inputs, lower, read
from modelgen.graph.operations import OPERATION_KINDS, count_operations

__all__ = [
    "OPERATION_KINDS",
    "Expr",
    "Graph",
    "Number",
    "Program",
    "Statement",
    "Term",
    "count_operations",
    "cut",
    "inputs",
    "lower",
    "read",
]
