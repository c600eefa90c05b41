"""Programs run statement by statement over any arithmetic, counting what is done."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from modelgen.graph import Program

CALLS: dict[str, Callable[..., Any]] = {
    **{n: getattr(math, n) for n in ("sin", "cos", "tan", "asin", "acos", "atan", "atan2")},
    **{n: getattr(math, n) for n in ("sqrt", "exp", "log", "tanh", "pow")},
    "abs": abs,
    "min": min,
    "max": max,
    "sign": lambda x: int(x > 0) - int(x < 0),
    "select": lambda c, a, b: a if c > 0 else b,
}
ARITHMETIC: dict[str, Callable[..., Any]] = {
    "neg": lambda a: -a,
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
}


@dataclass
class Run:
    """What a program has computed: outputs by (name, element), guards in order, operations done."""

    outputs: dict[tuple[str, int], Any] = field(default_factory=dict)
    guards: list[tuple[int, Any]] = field(default_factory=list)
    done: Counter[str] = field(default_factory=Counter)


def run(
    program: Program,
    inputs: Mapping[str, Sequence[Any]],
    constant: Callable[[float], Any] = float,
    calls: Mapping[str, Callable[..., Any]] = CALLS,
) -> Run:
    """Execute; `constant` takes a literal into the arithmetic of the inputs."""
    result = Run()
    values: dict[int, Any] = {}

    def evaluate(term: tuple[Any, ...]) -> Any:
        tag = term[0]
        if tag == "const":
            return constant(term[1])
        if tag == "in":
            return inputs[term[1]][term[2]]
        if tag == "let":
            return values[term[1]]
        operation = calls[term[1]] if tag == "call" else ARITHMETIC[tag]
        operands = [evaluate(part) for part in term[1:] if isinstance(part, tuple)]
        result.done[term[1] if tag == "call" else tag] += 1
        return operation(*operands)

    for statement in program.statements:
        value = evaluate(statement.term)
        if isinstance(statement.target, int):
            assert statement.target not in values
            values[statement.target] = value
        elif statement.target[0] == "guard":
            result.guards.append((statement.target[1], value))
        else:
            assert statement.target not in result.outputs
            result.outputs[statement.target] = value
    return result
