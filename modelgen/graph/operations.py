"""Counting the operations of a program."""

from __future__ import annotations

from collections.abc import Mapping

from modelgen.graph.lowering import LEAVES, Program, Term

OPERATION_KINDS = ("mul", "add", "neg", "div", "sqrt", "trig", "other")
_TRIGONOMETRIC = frozenset({"sin", "cos", "tan", "asin", "acos", "atan", "atan2"})


def _kind(term: Term) -> str:
    """Of what is no leaf."""
    tag, name, *_ = term
    if tag == "call":
        return "sqrt" if name == "sqrt" else "trig" if name in _TRIGONOMETRIC else "other"
    return "add" if tag == "sub" else str(tag)


def count_operations(program: Program) -> Mapping[str, int]:
    """Operations by kind; a subtraction is an addition, `other` are exp, tanh, sign and the like."""
    counts = dict.fromkeys(OPERATION_KINDS, 0)
    stack = [statement.term for statement in program.statements]
    while stack:
        term = stack.pop()
        if term[0] not in LEAVES:
            counts[_kind(term)] += 1
            stack.extend(term[2:] if term[0] == "call" else term[1:])
    return counts
