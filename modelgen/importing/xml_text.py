"""XML to elements that know their line. Entities and document types are refused before anything is expanded.

The standard library's expat reads; nothing outside the file is ever fetched.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

import numpy as np

from modelgen.errors import InputError, Location
from modelgen.importing.rounded import Rounding
from modelgen.numeric import Array

DAMPING = ("damping", "quadratic", "cubic")  # laws of the coefficients of a polynomial of the speed
MAX_BYTES = 20_000_000
MAX_DEPTH = 200


@dataclass
class Element:
    """One element: its tag, attributes, children, text and where it stands."""

    tag: str
    attributes: dict[str, str]
    file: str
    line: int
    children: list[Element] = field(default_factory=list)
    content: str = ""

    def all(self, *tags: str) -> list[Element]:
        """The children with one of the tags."""
        return [child for child in self.children if child.tag in tags]

    def first(self, tag: str) -> Element | None:
        """The first child with the tag."""
        return next(iter(self.all(tag)), None)

    def below(self) -> Iterator[Element]:
        """This element and all below it, in the order of the file."""
        yield self
        for child in self.children:
            yield from child.below()

    def error(self, message: str) -> InputError:
        """The InputError for this element."""
        return InputError(message, Location(self.file, self.line, 1))

    def text(self, name: str) -> str:
        """An attribute that must be there."""
        if not self.attributes.get(name, "").strip():
            raise self.error(f"<{self.tag}> has no attribute '{name}'")
        return self.attributes[name].strip()

    def number(self, name: str, default: float | None = None) -> float:
        """An attribute as a number; an error where it is missing and there is no default."""
        if default is not None and name not in self.attributes:
            return default
        return self._numbers(name, 1)[0]

    def vector(self, name: str, size: int, default: Array | None = None) -> Array:
        """An attribute as `size` numbers."""
        if default is not None and name not in self.attributes:
            return default
        return np.array(self._numbers(name, size))

    def numbers(self, name: str) -> list[float]:
        """An attribute as numbers, however many."""
        return self._numbers(name, len(self.text(name).split()))

    def damping(self) -> dict[str, float]:
        """Coefficients of the polynomial of the speed in `damping`, those that are not zero."""
        given = self.numbers("damping") if "damping" in self.attributes else []
        if len(given) > len(DAMPING):
            raise self.error(
                f"<{self.tag} damping>: found {len(given)} values, expected {len(DAMPING)} at most"
            )
        return {law: value for law, value in zip(DAMPING, given, strict=False) if value}

    def angles(self, name: str, size: int, rounding: Rounding) -> Array:
        """As `vector`, angles [rad], rounded ones as `rounding` takes them."""
        values = self._numbers(name, size)
        tokens = self.text(name).split()
        return np.array([rounding.angle(t, v) for t, v in zip(tokens, values, strict=True)])

    def _numbers(self, name: str, size: int) -> list[float]:
        tokens = self.text(name).split()
        if len(tokens) != size:
            what = "a number" if size == 1 else f"{size} numbers"
            raise self.error(f"<{self.tag} {name}>: found {len(tokens)} values, expected {what}")
        values = []
        for token in tokens:
            try:
                value = float(token)
            except ValueError:
                hint = "; expand xacro first: xacro FILE > robot.urdf" if "$" in token else ""
                raise self.error(
                    f"<{self.tag} {name}>: found '{token[:40]}', expected a number{hint}"
                ) from None
            if not math.isfinite(value):
                raise self.error(f"<{self.tag} {name}>: found '{token[:40]}', expected a finite number")
            values.append(value)
        return values


def read_xml(path: Path) -> Element:
    """The root element of a file. Raises InputError, with the line, where it is no XML."""
    try:
        data = path.read_bytes()
    except FileNotFoundError:
        raise InputError(f"{path}: there is no such file") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None
    if len(data) > MAX_BYTES:
        raise InputError(f"{path}: found {len(data)} bytes, at most {MAX_BYTES} are read")
    return parse_xml(data, str(path))


def parse_xml(data: bytes, file: str) -> Element:
    """The root element of a text; `file` is the name that messages show. Raises as `read_xml`."""
    parser = expat.ParserCreate()
    stack: list[Element] = []
    roots: list[Element] = []

    def here() -> Location:
        return Location(file, parser.CurrentLineNumber, parser.CurrentColumnNumber + 1)

    def start(tag: str, attributes: dict[str, str]) -> None:
        if len(stack) >= MAX_DEPTH:
            raise InputError(f"elements are nested deeper than {MAX_DEPTH} levels", here())
        element = Element(tag, attributes, file, parser.CurrentLineNumber)
        (stack[-1].children if stack else roots).append(element)
        stack.append(element)

    def refuse(*_: object) -> None:
        raise InputError("found a document type with entities, which are not read; remove <!DOCTYPE>", here())

    def end(_: str) -> None:
        stack.pop()

    def text(data: str) -> None:
        if stack and len(stack[-1].content) < 200:
            stack[-1].content += data.strip()

    parser.CharacterDataHandler = text
    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.StartDoctypeDeclHandler = refuse
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        where = Location(file, error.lineno, error.offset + 1)
        raise InputError(f"this is no XML: {expat.ErrorString(error.code)}", where) from None
    except ValueError as error:  # an encoding that expat does not know
        raise InputError(f"{file}: this is no XML: {error}") from None
    return roots[0]
