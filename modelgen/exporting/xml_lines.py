"""XML as lines that read well, the same on any machine."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from xml.sax.saxutils import escape, quoteattr

from modelgen.importing.rounded import near_angle

_LEAST = 1e-15  # m or of a direction: what arithmetic leaves of zero
NOISE = 1e-14  # rad, of arithmetic


def element(tag: str, inside: Sequence[str] | str = (), /, **attributes: str | None) -> list[str]:
    """An element with lines or one text inside; attributes without a value are left out."""
    given = "".join(f" {name}={quoteattr(value)}" for name, value in attributes.items() if value is not None)
    if isinstance(inside, str):
        return [f"<{tag}{given}>{escape(inside)}</{tag}>"]
    if not inside:
        return [f"<{tag}{given}/>"]
    return [f"<{tag}{given}>", *(f"  {line}" for line in inside), f"</{tag}>"]


def comment(lines: Sequence[str]) -> list[str]:
    """Lines that are for the reader."""
    return ["<!--", *(f"  {line}".rstrip().replace("--", "- -") for line in lines), "-->"]


def figure(value: float) -> str:
    """A number as it stands."""
    return f"{value + 0.0:.15g}"


def figures(values: Iterable[float]) -> str:
    """Several."""
    return " ".join(figure(float(value)) for value in values)


def places(values: Iterable[float]) -> str:
    """Coordinates and directions, without what arithmetic leaves of zero, or adds to the last digits."""
    return " ".join(f"{0.0 if abs(value) < _LEAST else float(value):.13g}" for value in values)


def angles(values: Iterable[float]) -> str:
    """Angles [rad], multiples of 15 degrees to the last digit."""
    return " ".join(f"{near_angle(float(value), NOISE) + 0.0:.17g}" for value in values)


def any_figure(value: float | None) -> str | None:
    """A number, None where it is nothing."""
    return figure(value) if value else None
