"""The statements of a function, one after the other, in the words of a dialect."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Protocol

from modelgen.backends.elements import Element
from modelgen.backends.printing import Dialect, expression
from modelgen.functions.objects import Function
from modelgen.graph import inputs


class Statements(Dialect, Protocol):
    """A dialect that can also assign."""

    def load(self, element: Element, source: str) -> str:
        """Give an element of an input its name; nothing where the name is known by then."""

    def let(self, number: int, text: str) -> str:
        """Define an intermediate value."""

    def store(self, output: str, index: int, text: str) -> str:
        """Set an element of an output."""

    def remarked(self, statement: str, text: str) -> str:
        """The statement with a remark, or without one where nobody reads it."""

    def guard(self, status: int, text: str) -> str:
        """Leave with `status` unless the value is positive; nothing where a language has no status."""


def body(
    function: Function,
    named: Mapping[str, Sequence[Element | None]],
    dialect: Statements,
) -> Iterator[str]:
    """The statements in print. An element with a name in `named` gets it right before its first use."""
    loaded: set[tuple[str, int]] = set()
    said = ""
    loads = any(element is not None for elements in named.values() for element in elements)
    for statement in function.program.statements:
        for vector, index in inputs(statement.term) if loads else ():
            elements = named.get(vector, ())
            element = elements[index] if elements else None
            if element is not None and (vector, index) not in loaded:
                loaded.add((vector, index))
                load = dialect.load(element, f"{vector}[{index}]")
                if load:
                    yield load
        text = expression(statement.term, dialect)
        if isinstance(statement.target, int):
            let = dialect.let(statement.target, text)
            new = statement.note and statement.note != said
            said = statement.note or said
            yield dialect.remarked(let, said) if new else let
        elif statement.target[0] == "guard":
            guard = dialect.guard(statement.target[1], text)
            if guard:
                yield guard
        else:
            yield dialect.store(*statement.target, text)


def unset(function: Function) -> dict[str, list[int]]:
    """Elements that the program leaves zero, by output."""
    written = {s.target for s in function.program.statements}
    return {
        output.name: [i for i in range(output.size) if (output.name, i) not in written]
        for output in function.outputs
    }
