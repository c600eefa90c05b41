"""A program whose input vectors have other names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from modelgen.graph.lowering import Program, Term


def renamed(program: Program, names: Mapping[str, str]) -> Program:
    """The program with the input vectors in `names` called what these say; the others keep their names."""

    def term(given: Term) -> Term:
        if given[0] == "in":
            return ("in", names.get(given[1], given[1]), given[2])
        return tuple(term(part) if isinstance(part, tuple) else part for part in given)

    statements = tuple(replace(s, term=term(s.term)) for s in program.statements)
    return replace(program, statements=statements)
