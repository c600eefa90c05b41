"""Counting the operations of a program."""

from __future__ import annotations

from collections.abc import Mapping

from modelgen.graph.lowering import Program, Term

OPERATION_KINDS = ("mul", "add", "neg", "div", "sqrt", "trig", "other")
_TRIGONOMETRIC = frozenset({"sin", "cos", "tan", "asin", "acos", "atan", "atan2"})


def _kind(term: Term) -> str | None:
    tag = term[0]
    if tag in ("add", "sub"):
        return "add"
    if tag in ("mul", "div", "neg"):
        return str(tag)
    if tag == "call":
        name = term[1]
        return "sqrt" if name == "sqrt" else "trig" if name in _TRIGONOMETRIC else "other"
    return None


def count_operations(program: Program) -> Mapping[str, int]:
    """Operations by kind; a subtraction is an addition, `other` are exp, tanh, sign and the like."""
    counts = dict.fromkeys(OPERATION_KINDS, 0)
    stack = [statement.term for statement in program.statements]
    while stack:
        term = stack.pop()
        kind = _kind(term)
        if kind:
            counts[kind] += 1
        stack.extend(part for part in term[1:] if isinstance(part, tuple))
    return counts
