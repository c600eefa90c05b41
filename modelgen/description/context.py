"""The context of an arm's checks: its place in the document, its symbols, and how to complain."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from modelgen.description.document import Node, Steps
from modelgen.description.expressions import ExpressionError, Quantity, evaluate
from modelgen.description.messages import describe, mistake
from modelgen.errors import InputError, Location

_NEEDS = {
    "angle": 'an angle such as 1.57, pi/2 or "90 deg"',
    "length": 'a length such as 0.05 or "50 mm"',
    "plain": "a number",
    "any": "a number",
}


@dataclass
class Context:
    """One arm of the document, while it is checked."""

    root: Node
    arm: str
    symbols: Mapping[str, float] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    def path(self, steps: Steps) -> list[str | int]:
        """Path in the document of the arm's value at `steps`."""
        return ["arms", self.arm, *steps]

    def where(self, steps: Steps, key: bool = False) -> Location:
        """Place of the arm's value at `steps`, or of its key."""
        return self.root.locate(self.path(steps), key)

    def error(self, message: str, steps: Steps, key: bool = False) -> InputError:
        """The InputError for the value (or the key) at `steps` of this arm."""
        return mistake(self.root, self.path(steps), message, key)

    def quantity(self, raw: float | str, kind: str, steps: Steps) -> Quantity:
        """The value as written, in SI units; `kind` as in `expressions.evaluate`."""
        try:
            return evaluate(raw, kind, self.symbols)
        except ExpressionError as error:
            found, expected = describe(raw), _NEEDS[kind]
            raise self.error(f"found {found}, expected {expected}: {error}", steps) from None

    def number(self, raw: float | str, kind: str, steps: Steps) -> float:
        """Read a number as `quantity` does, without symbols."""
        return self.quantity(raw, kind, steps).value

    def numbers(self, raw: list[float | str], kind: str, steps: Steps) -> tuple[float, ...]:
        """Read a list of numbers."""
        return tuple(self.number(value, kind, [*steps, i]) for i, value in enumerate(raw))

    def positive(self, raw: float | str | None, kind: str, steps: Steps) -> float | None:
        """A magnitude: None where it is not given, an error unless it is above zero."""
        if raw is None:
            return None
        value = self.number(raw, kind, steps)
        if value <= 0.0:
            raise self.error(f"found {describe(raw)}, expected a magnitude above 0", steps)
        return value

    def nonzero(self, raw: float | str, kind: str, steps: Steps) -> Quantity:
        """Read a value as `quantity` does; 0 is an error."""
        quantity = self.quantity(raw, kind, steps)
        if quantity.value == 0.0:
            raise self.error("found 0, expected a value other than 0", steps)
        return quantity


def show(value: float, kind: str) -> str:
    """A joint coordinate for people: degrees or metres."""
    return f"{math.degrees(value):.6g} deg" if kind == "angle" else f"{value:.6g} m"
