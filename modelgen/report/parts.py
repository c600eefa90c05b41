"""What pages are put together of: each part has a template of its own, and hands it what stands there."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import compress
from typing import Any, ClassVar

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

from modelgen.charts import Chart, drawn, labels, mark
from modelgen.resources import templates_folder

_FIXED = "\N{NO-BREAK SPACE}"
_ANSWERS = {"yes": "passed", "no": "failed", "unasked": "not asked"}


class Part:
    """A part of a page. kind: name of its template, which finds `values` by their names."""

    kind: ClassVar[str]

    def values(self) -> Mapping[str, Any]:
        """For the template."""
        return vars(self)


@dataclass(frozen=True)
class Run:
    """A piece of a line. look: "strong", "quiet", "code" or none; target: of a link, empty for none."""

    text: str
    look: str = ""
    target: str = ""


Line = str | Sequence[Run]


@dataclass(frozen=True)
class Text(Part):
    """A paragraph. look: class of its style."""

    kind: ClassVar[str] = "text"
    text: Line
    look: str = ""

    def values(self) -> Mapping[str, Any]:
        """For the template."""
        return {"text": line(self.text), "look": self.look}


@dataclass(frozen=True)
class Heading(Part):
    """A heading below that of a section. anchor: by which links find it, empty for none."""

    kind: ClassVar[str] = "heading"
    text: str
    anchor: str = ""


@dataclass(frozen=True)
class Command(Part):
    """A command to copy."""

    kind: ClassVar[str] = "command"
    text: str


@dataclass(frozen=True)
class Lines(Part):
    """A list."""

    kind: ClassVar[str] = "list"
    lines: Sequence[Line]

    def values(self) -> Mapping[str, Any]:
        """For the template."""
        return {"lines": [line(each) for each in self.lines]}


@dataclass(frozen=True)
class Grid(Part):
    """A table. heads: each with the side that its cells stand at. Of two texts in a cell one is small.

    folds: on a narrow screen every row is a list of its cells, each behind its head. beside: on a wide screen
    it stands beside the texts of its answer. long: narrow and of many rows, in columns on paper.
    """

    kind: ClassVar[str] = "table"
    caption: str
    heads: Sequence[tuple[str, str]]
    rows: Sequence[Sequence[str | tuple[str, str]]]
    folds: bool = False
    beside: bool = False
    long: bool = False

    def values(self) -> Mapping[str, Any]:
        """For the template."""
        columns, cells_of = self._columns()
        looks = ["n" if side == "right" else "u" if head == "unit" else "" for head, side in columns]
        heads = [{"text": _head(head), "look": "n" if side == "right" else ""} for head, side in columns]
        rows = [
            [_cell(cell, look, head) for cell, look, (head, _) in zip(row, looks, columns, strict=True)]
            for row in cells_of
        ]
        looks_of_all = {"folds": self.folds, "beside": self.beside, "long": self.long}
        return {"caption": self.caption, "heads": heads, "rows": rows, **looks_of_all}

    def _columns(self) -> tuple[list[tuple[str, str]], list[list[str | tuple[str, str]]]]:
        """Heads and rows. Unit "1" is not shown, and a column of units that has none is left out."""
        names = [head for head, _ in self.heads]
        rows = [
            ["" if name == "unit" and cell == "1" else cell for name, cell in zip(names, row, strict=True)]
            for row in self.rows
        ]
        kept = [
            name != "unit" or not rows or any(column)
            for name, column in zip(names, zip(*rows, strict=True) if rows else names, strict=True)
        ]
        return list(compress(self.heads, kept)), [list(compress(row, kept)) for row in rows]


@dataclass(frozen=True)
class Block(Part):
    """Charts with one legend. charts: title and SVG; legend: role, label and whether it is dots of each."""

    kind: ClassVar[str] = "charts"
    charts: Sequence[tuple[str, Markup]]
    legend: Sequence[tuple[str, str, bool]] = ()
    zooms: bool = False

    def values(self) -> Mapping[str, Any]:
        """For the template."""
        legend = [
            {
                "label": label,
                "band": role == "noise",
                "look": "" if role == "noise" else f"{'dots' if dotted else 'line'} {role}",
                "path": mark(role, 13, 5, 1.0) if dotted else "M1 5h24",
            }
            for role, label, dotted in self.legend
        ]
        return {"charts": self.charts, "legend": legend, "zooms": self.zooms}


@dataclass(frozen=True)
class Marks(Part):
    """Answers of checks in a row, each with its figures on hover, tap or focus.

    marks: "yes", "no" or "unasked", name and figures. key: by which the page tells them from others.
    """

    kind: ClassVar[str] = "marks"
    key: str
    marks: Sequence[tuple[str, str, str]]

    def values(self) -> Mapping[str, Any]:
        """For the template."""
        return {"marks": _signed(self.key, self.marks)}


@dataclass(frozen=True)
class Checks(Part):
    """Answers of the same checks of several things: a row of marks for each, a column for each check.

    rows: text, target of its link, and marks.
    """

    kind: ClassVar[str] = "checks"
    caption: str
    rows: Sequence[tuple[str, str, Marks]]

    def values(self) -> Mapping[str, Any]:
        """For the template."""
        rows = [
            {"text": breaking(text), "target": target, "marks": _signed(marks.key, marks.marks)}
            for text, target, marks in self.rows
        ]
        heads = [name for _, name, _ in self.rows[0][2].marks]
        return {"caption": self.caption, "heads": heads, "rows": rows}


@dataclass(frozen=True)
class Folded(Part):
    """What is folded away until it is asked for.

    screen: not on paper, and no section of the page. printed: whether it is on paper, unfolded. narrow: it is
    folded on narrow screens alone.
    """

    kind: ClassVar[str] = "folded"
    title: str
    parts: Sequence[Part | str]
    screen: bool = False
    printed: bool = True
    narrow: bool = False

    def values(self) -> Mapping[str, Any]:
        """For the template."""
        look = "section screen" if self.screen else "section" if self.printed else "section unprinted"
        if self.narrow:
            beside = any(isinstance(p, Grid) and p.beside for p in self.parts)
            look += " narrow beside" if beside else " narrow"
        return {"title": self.title, "parts": html(self.parts), "look": look, "narrow": self.narrow}


def breaking(name: str) -> Markup:
    """A name that may break between its words."""
    return escape(name).replace("_", Markup("_<wbr>"))


def _signed(key: str, marks: Sequence[tuple[str, str, str]]) -> list[dict[str, str]]:
    signs = {"yes": "✓", "no": "✗", "unasked": "–"}
    return [
        {
            "look": look,
            "sign": signs[look],
            "name": name,
            "answer": _ANSWERS[look],
            "text": text,
            "anchor": f"{key}-{k}",
        }
        for k, (look, name, text) in enumerate(marks, 1)
    ]


def html(parts: Sequence[Part | str]) -> list[Markup]:
    """Every part by its template; what is text already as it is."""
    return [_filled(p.kind, p.values()) if isinstance(p, Part) else Markup.escape(p) for p in parts]


def line(text: Line) -> Markup:
    """A line by its template."""
    runs = [Run(text)] if isinstance(text, str) else text
    return _filled("line", {"runs": [_looks(run) for run in runs]})


def steps(parts: Sequence[Any]) -> list[tuple[str, str]]:
    """Texts of parts, each with the command that follows on it; empty where none does."""
    found: list[tuple[str, str]] = []
    for part in parts:
        if isinstance(part, Command):
            found[-1] = found[-1][0], part.text
        elif isinstance(part, Text):
            runs = [part.text] if isinstance(part.text, str) else [run.text for run in part.text]
            found.append(("".join(runs), ""))
    return found


def block(charts: Sequence[Chart]) -> Block:
    """Drawn charts that stand beside and below each other."""
    return Block([(c.title, Markup(drawn(c))) for c in charts], labels(charts), any(c.zoom for c in charts))


@cache
def environment() -> Environment:
    """Environment of the templates of pages."""
    return Environment(
        loader=FileSystemLoader(templates_folder() / "report"),
        undefined=StrictUndefined,
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def _filled(kind: str, values: Mapping[str, Any]) -> Markup:
    return Markup(environment().get_template(f"{kind}.html.j2").render(values).rstrip("\n"))


def _looks(run: Run) -> dict[str, Any]:
    kinds = {"strong": run.look == "strong", "code": run.look == "code"}
    plain = not run.target and not any(kinds.values())
    linked, quiet = bool(run.target), run.look == "quiet"
    return {"text": run.text, "target": run.target, "linked": linked, "quiet": quiet, "plain": plain, **kinds}


def _head(text: str) -> str:
    """What a head of a column has in brackets stays on one line."""
    return re.sub(r"[(\[].*?[)\]]", lambda m: m[0].replace(" ", _FIXED), text)


def _cell(cell: str | tuple[str, str], look: str, head: str) -> dict[str, str]:
    text, small = (cell, "") if isinstance(cell, str) else cell
    return {"text": text, "small": small, "look": look, "head": head}
