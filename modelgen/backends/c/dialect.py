"""How C spells the terms and statements of a program."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from decimal import Decimal

from modelgen.backends.c.pairs import Pair
from modelgen.backends.elements import Element
from modelgen.backends.text import UNBROKEN, with_remark, wrapped, wrapped_code
from modelgen.functions.objects import (
    STATUS_INPUT,
    STATUS_PIVOT,
    STATUS_STROKE,
    Function,
    least_guarded,
)
from modelgen.graph import Term, read

STATUS = {STATUS_STROKE: "STROKE", STATUS_PIVOT: "PIVOT", STATUS_INPUT: "INPUT"}
INDENT = "    "
OUTPUT_LIMIT = 1e15  # what the magnitudes of an output's elements may add up to where they are tested

# Normal numbers of IEEE 754 single precision: every constant must be one, or zero.
_SMALLEST, _LARGEST = 1.1754943508222875e-38, 3.4028234663852886e38


def literal(arm: str, value: float) -> str:
    """A number in the arm's precision, in the fewest digits that give back the double.

    Raises ValueError where single precision cannot hold it.
    """
    if value and not _SMALLEST <= abs(value) <= _LARGEST:
        raise ValueError(f"{arm}: the constant {value!r} is out of the range of single precision")
    digits = repr(float(value))
    if "e" in digits or digits.endswith("00.0"):
        mantissa, exponent = f"{Decimal(digits):e}".split("e")
        whole, _, decimals = mantissa.partition(".")
        digits = f"{whole}.{decimals.rstrip('0') or '0'}e{int(exponent)}"
    return f"{arm.upper()}_C({digits})"


def destinations(function: Function) -> dict[str, tuple[str, int]]:
    """Array argument that holds each output, and where the output begins there."""
    if len(function.outputs) == 1:
        return {function.outputs[0].name: ("out", 0)}
    if not function.stacked:
        return {output.name: (output.name, 0) for output in function.outputs}
    result, offset = {}, 0
    for output in function.outputs:
        result[output.name] = ("out", offset)
        offset += output.size
    return result


def arrays(function: Function) -> dict[str, int]:
    """The output arguments and their lengths."""
    lengths: dict[str, int] = {}
    places = destinations(function)
    for output in function.outputs:
        array, _ = places[output.name]
        lengths[array] = lengths.get(array, 0) + output.size
    return lengths


def _built_on(function: Function) -> frozenset[int]:
    """Temporaries that are elements of outputs and that other statements read."""
    stored: set[int] = set()
    used: set[int] = set()
    for statement in function.program.statements:
        target = statement.target
        element = isinstance(target, tuple) and target[0] != "guard"
        if element and statement.term[0] == "let":
            stored.add(statement.term[1])
        else:
            used.update(read(statement.term))
    return frozenset(stored & used)


def _factors(function: Function) -> frozenset[int]:
    """Temporaries that are one over a pivot, before the last pivot is known: L of a matrix L D L'."""
    statements = function.program.statements
    guards = [k for k, s in enumerate(statements) if isinstance(s.target, tuple) and s.target[0] == "guard"]
    before = statements[: max(guards, default=0)]
    pivots = {statements[k].term for k in guards}
    inverses: set[Term] = set()
    found = set()
    for target, term in ((s.target, s.term) for s in before if isinstance(s.target, int)):
        if term[0] == "div" and term[2] in pivots:
            inverses.add(("let", target))
        elif term[0] == "mul" and not inverses.isdisjoint(term[1:]):
            found.add(target)
    return frozenset(found)


class CDialect:
    """Statements of one function in C99.

    checked: whether the function tests its outputs at the end. Those elements on which it builds before are
    then held where they are defined. Where one output is built on another, as derivatives on accelerations,
    so are the factors with which equations are solved again: none comes near the limit where a solution
    exists, but a proof by intervals does not know it.
    """

    def __init__(
        self,
        arm: str,
        function: Function,
        named: Mapping[str, Sequence[Element | None]],
        *,
        checked: bool = False,
    ) -> None:
        self.arm = arm
        self.held = _built_on(function) if checked else frozenset()
        if self.held and len(function.outputs) > 1:
            self.held |= _factors(function)
        self.macro = arm.upper()
        self.named = named
        self.places = destinations(function)
        self.real = f"const {arm}_real_t"
        self.zeros = [f"{arm}_zero({array}, {size});" for array, size in arrays(function).items()]

    def constant(self, value: float) -> str:
        """Write a number as a literal."""
        return literal(self.arm, value)

    def element(self, vector: str, index: int) -> str:
        """The element by its own name where it has one."""
        elements = self.named.get(vector)
        element = elements[index] if elements else None
        return f"{vector}[{element.name if element else index}]"

    def temporary(self, number: int) -> str:
        """t0, t1, ..."""
        return f"t{number}"

    def call(self, function: str, arguments: Sequence[str]) -> str:
        """A macro for what the C library has, an inline function of the private header for the rest."""
        listed = ", ".join(arguments)
        if function in ("sign", "min", "max", "select"):
            return f"{self.arm}_{function}({listed})"
        return f"{self.macro}_{function.upper()}({listed})"

    def load(self, element: Element, source: str) -> str:
        """Nothing: the names are enumerators of the function's block, see `indices`."""
        return ""

    def indices(self) -> list[str]:
        """Declarations of the names by which elements of the inputs are read.

        An index costs nothing, whereas a copy of the element would occupy a register.
        """
        lines = []
        for elements in self.named.values():
            names = []
            for i, element in enumerate(elements):
                if element is not None:
                    counted = i > 0 and elements[i - 1] is not None
                    names.append(element.name if counted else f"{element.name}{UNBROKEN}={UNBROKEN}{i}")
            if names:
                lines.append(wrapped(f"enum {{ {', '.join(names)} }};", INDENT, INDENT * 2))
        return lines

    def let(self, number: int, text: str) -> str:
        """An intermediate value is defined once and never changes."""
        text = f"{self.arm}_held({text})" if number in self.held else text
        return wrapped_code(f"{self.real} t{number} = {text};", INDENT, INDENT * 2)

    def pair(self, pair: Pair) -> str:
        """Sine and cosine of one angle."""
        sine, cosine = self.temporary(pair.sine), self.temporary(pair.cosine)
        angle = self.element(*pair.angle[1:])
        return (
            f"{INDENT}{self.arm}_real_t {sine}, {cosine};\n"
            f"{INDENT}{self.macro}_SINCOS({angle}, &{sine}, &{cosine});"
        )

    def store(self, output: str, index: int, text: str) -> str:
        """Store an element in the array that holds the output."""
        array, offset = self.places[output]
        return wrapped_code(f"{array}[{offset + index}] = {text};", INDENT, INDENT * 2)

    def remarked(self, statement: str, text: str) -> str:
        """Behind the statement where there is room, else before it."""
        return with_remark(statement, f"/* {text} */", INDENT)

    def guard(self, status: int, text: str) -> str:
        """Zeros and a status; the comparison is false for what is not a number."""
        return self.leave(
            f"!({text} > {self.constant(least_guarded(status))})", f"{self.macro}_STATUS_{STATUS[status]}"
        )

    def leave(self, condition: str, status: str) -> str:
        """Write zeros and return."""
        inner = "\n".join(f"{INDENT * 2}{zero}" for zero in self.zeros)
        return f"{INDENT}if ({condition}) {{\n{inner}\n{INDENT * 2}return {status};\n{INDENT}}}"
