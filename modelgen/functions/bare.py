"""A function of expressions alone, with no description around it."""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.functions.objects import Argument, Function, Output
from modelgen.graph import Expr, lower
from modelgen.model.equations import Equations


def bare(name: str, e: Equations, count: int, expressions: Sequence[Expr]) -> Function:
    """A function of everything that its expressions read; `count` base parameters; one output "out"."""
    program = lower({"out": list(expressions)}, [], None)
    n = e.n
    sizes = {
        **dict.fromkeys(("q", "dq", "ddq", "load", "input"), n),
        "parameters": count,
        "time": 1,
        "dt": 1,
        "state": len(e.state_names()),
        "free": len(e.free),
        "geometry": sum(x.value is None for x in e.scalars.symbols.values()),
    }
    arguments = [Argument(a, size, "", "", float("inf")) for a, size in sizes.items() if size]
    output = Output("out", len(expressions), 1, "", "")
    return Function(name, "", tuple(arguments), (output,), program, {})
