"""Terms as text: the operator precedence that C and Python share, and no parenthesis too many.

The text is parsed back to the same tree: a sum is never regrouped, so that every language rounds alike.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from modelgen.graph import Term

_SUM, _PRODUCT, _SIGN, _ATOM = range(4)
_BINARY = {
    "add": ("+", _SUM),
    "sub": ("-", _SUM),
    "mul": ("*", _PRODUCT),
    "div": ("/", _PRODUCT),
}


class Dialect(Protocol):
    """A dialect spells what differs between languages."""

    def constant(self, value: float) -> str:
        """A number, negative ones with their sign."""

    def element(self, vector: str, index: int) -> str:
        """An element of an input."""

    def temporary(self, number: int) -> str:
        """A named intermediate value."""

    def call(self, function: str, arguments: Sequence[str]) -> str:
        """A function of the graph applied to arguments in print; the result binds like a name."""


def expression(term: Term, dialect: Dialect) -> str:
    """The term in print."""
    return _print(term, dialect)[0]


def _print(term: Term, dialect: Dialect) -> tuple[str, int]:
    """Text of a term, and how tightly its outermost operator binds."""
    tag = term[0]
    if tag == "let":
        return dialect.temporary(term[1]), _ATOM
    if tag == "in":
        return dialect.element(term[1], term[2]), _ATOM
    if tag == "const":
        return dialect.constant(term[1]), _SIGN if term[1] < 0.0 else _ATOM
    if tag == "call":
        return dialect.call(term[1], [_print(part, dialect)[0] for part in term[2:]]), _ATOM
    if tag == "neg":
        text, level = _print(term[1], dialect)
        return f"-{_enclosed(text, level <= _SIGN)}", _SIGN
    sign, own = _BINARY[tag]
    left, level = _print(term[1], dialect)
    left = _enclosed(left, level < own)
    right, level = _print(term[2], dialect)
    # Both languages group from the left: an equal operator on the right keeps its parentheses.
    right = _enclosed(right, level <= own)
    return f"{left} {sign} {right}", own


def _enclosed(text: str, needed: bool) -> str:
    return f"({text})" if needed else text
