"""Text that every language needs: wrapped lines, tables in comments, counted operations."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from modelgen.resources import templates_folder

WIDTH = 110
UNBROKEN = "\N{NO-BREAK SPACE}"  # stands for a blank at which a line may not end
# What would end a comment or a docstring, continue a line, or begin a trigraph.
_ENDS = {"*/": "* /", "/*": "/ *", "\\": "/", '"': "'", "??": "? ?"}


def wrapped(text: str, indent: str = "", continuation: str | None = None, width: int = WIDTH) -> str:
    """The text on lines of at most `width` where its blanks allow it; UNBROKEN is one that does not."""
    if len(indent) + len(text) <= width:
        return indent + text.replace(UNBROKEN, " ")
    return "\n".join(
        textwrap.wrap(
            text,
            width,
            initial_indent=indent,
            subsequent_indent=indent if continuation is None else continuation,
            break_long_words=False,
            break_on_hyphens=False,
        )
    ).replace(UNBROKEN, " ")


def wrapped_code(text: str, indent: str, continuation: str) -> str:
    """A statement on lines of at most WIDTH, broken before a sum's sign or after a comma."""
    if len(indent) + len(text) <= WIDTH:
        return indent + text
    for sign in "*/=":
        text = text.replace(f" {sign} ", f"{UNBROKEN}{sign}{UNBROKEN}")
    for sign in "+-":
        text = text.replace(f" {sign} ", f" {sign}{UNBROKEN}")
    return wrapped(text, indent, continuation)


def with_remark(statement: str, remark: str, indent: str) -> str:
    """A statement and a remark on one line, or the remark on a line before where they do not fit."""
    if "\n" not in statement and len(statement) + 1 + len(remark) <= WIDTH:
        return f"{statement} {remark}"
    return f"{indent}{remark}\n{statement}"


def table(rows: Iterable[Sequence[str]], width: int = WIDTH - 3) -> list[str]:
    """Rows in aligned columns; the last column is wrapped below itself."""
    cells = [[cell.strip() for cell in row] for row in rows]
    if not cells:
        return []
    widths = [max(len(row[k]) for row in cells) for k in range(len(cells[0]) - 1)]
    lines: list[str] = []
    for row in cells:
        head = "".join(f"{cell:{size}}  " for cell, size in zip(row, widths, strict=False))
        lines += wrapped(row[-1] or "-", head, " " * len(head), width).rstrip().split("\n")
    return lines


def plain(text: str) -> str:
    """Text of a user as one line that fits into any comment or docstring."""
    line = " ".join("".join(c if c.isprintable() else " " for c in text).split())
    for ends, harmless in _ENDS.items():
        line = line.replace(ends, harmless)
    return line


def operations(counts: Mapping[str, int]) -> str:
    """The counts in print: additions, multiplications and negations first, then what costs more."""
    cheap = ", ".join(f"{counts[kind]} {kind}" for kind in ("mul", "add", "neg"))
    total = sum(counts[kind] for kind in ("mul", "add", "neg"))
    rest = [f"{counts[kind]} {kind}" for kind in ("div", "sqrt", "trig") if counts.get(kind)]
    rest += [f"{counts['other']} other calls (sign, select and the like)"] if counts.get("other") else []
    return f"Operations: {total} ({cheap})" + "".join(f", {part}" for part in rest) + "."


def render(template: str, **values: Any) -> str:
    """A template filled with ready-made strings. Raises jinja2.UndefinedError where one is missing."""
    return _environment().get_template(template).render(**values)


@cache
def _environment() -> Environment:
    return Environment(
        loader=FileSystemLoader(templates_folder()),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,  # the output is no HTML
    )
