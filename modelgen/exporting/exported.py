"""What an export gives back, and what a file says of itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from modelgen.description.objects import Arm
from modelgen.exporting.account import Row


@dataclass(frozen=True)
class Exported:
    """A file of another format.

    form, title: the format's name here and to people. text: the file, of an archive its description.
    content: its bytes. rows: what it has of each effect. notes: what the user must know besides.
    """

    arm: Arm
    form: str
    title: str
    text: str
    content: bytes
    rows: tuple[Row, ...]
    notes: tuple[str, ...]


def heading(name: str, source: str, rows: Sequence[Row], notes: Sequence[str]) -> list[str]:
    """What the file says of itself: what it has of each effect, in columns."""
    lines = [f"{name}, written by modelgen."]
    if source:
        lines.append(f"Source: {' '.join(source.split())}")
    if rows:
        cells = [("effect", "joint", "here", "largest error", "as"), *(row.cells() for row in rows)]
        widths = [max(len(row[k]) for row in cells) for k in range(4)]
        lines.append("")
        for row in cells:
            padded = "  ".join(cell.ljust(width) for cell, width in zip(row[:4], widths, strict=True))
            lines.append(f"{padded}  {row[4]}")
    lines.append("")
    return [*lines, *(f"Note: {note}." for note in notes)]
