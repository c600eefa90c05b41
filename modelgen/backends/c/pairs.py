"""Sines and cosines of one angle, which C computes together."""

from __future__ import annotations

from dataclasses import dataclass

from modelgen.graph import Program, Term


@dataclass(frozen=True)
class Pair:
    """The temporaries that hold the sine and the cosine of `angle`, an element of an input."""

    angle: Term
    sine: int
    cosine: int


def pairs(program: Program) -> tuple[list[Pair], Program]:
    """The pairs in order of their angles, and the program without the statements that they replace.

    Both functions of an angle take the same reduction, so that the second one is cheap. Pairs of inputs
    alone count: they can be computed before anything else, so that no other value has to be kept
    over a call.
    """
    found: dict[Term, dict[str, int]] = {}
    for statement in program.statements:
        term = statement.term
        if isinstance(statement.target, int) and _of_input(term):
            found.setdefault(term[2], {})[term[1]] = statement.target
    complete = [
        Pair(angle, numbers["sin"], numbers["cos"])
        for angle, numbers in sorted(found.items())
        if len(numbers) == len(("sin", "cos"))
    ]
    replaced = {number for pair in complete for number in (pair.sine, pair.cosine)}
    rest = tuple(statement for statement in program.statements if statement.target not in replaced)
    return complete, Program(rest, program.temporaries)


def _of_input(term: Term) -> bool:
    """Whether the term is the sine or the cosine of an element of an input."""
    return term[0] == "call" and term[1] in ("sin", "cos") and term[2][0] == "in"
