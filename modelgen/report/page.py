"""A page: questions with their answers first, then sections, with style and script inside."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from markupsafe import Markup

from modelgen.charts import Interval, intervals
from modelgen.report.parts import (
    Block,
    Checks,
    Command,
    Folded,
    Grid,
    Heading,
    Line,
    Lines,
    Marks,
    Part,
    Run,
    Text,
    block,
    environment,
    html,
)
from modelgen.resources import templates_folder
from modelgen.version import __version__

__all__ = [
    "WIDE",
    "Block",
    "Checks",
    "Command",
    "Folded",
    "Grid",
    "Heading",
    "Line",
    "Lines",
    "Marks",
    "Part",
    "Parts",
    "Run",
    "Section",
    "Text",
    "block",
    "inline",
    "page",
    "pictured",
]

WIDE = 1.96  # standard deviations of a 95 % interval


class Section(NamedTuple):
    """A heading with what stands below it. anchor: by which links find it, empty for none."""

    title: str
    parts: Sequence[Part | str]
    anchor: str = ""


Parts = Sequence[Section | tuple[str, Sequence[Part | str]]]


def page(title: str, task: str, answers: Parts, sections: Parts, own: str = "") -> str:
    """HTML of a result that needs nothing beside it: what the first screen shows, then sections.

    own: name of the style and the script that this page has besides, empty for none.
    """
    names = ("page", own) if own else ("page",)
    made = (
        environment()
        .get_template("page.html.j2")
        .render(
            title=title,
            task=task,
            answers=[_filled(a) for a in answers],
            next_title=answers[-1][0] if answers else "",
            sections=[_filled(s) for s in sections],
            style=_joined("chart.css", *(f"{name}.css" for name in names)),
            script=_joined(*(f"{name}.js" for name in names)),
            version=__version__,
        )
    )
    return "\n".join(line.rstrip() for line in made.splitlines() if line.strip()) + "\n"


def pictured(rows: Sequence[Interval], x_label: str, text: str, title: str = "") -> tuple[str, Markup]:
    """Values with their intervals as one of the charts of a block."""
    return title, Markup(intervals(rows, x_label, text))


def inline(text: str) -> Markup:
    """A picture from its svg element on, which the page holds as it is."""
    return Markup(text[text.index("<svg") :])


def _filled(section: Section | tuple[str, Sequence[Part | str]]) -> dict[str, Any]:
    title, parts, anchor = Section(*section)
    return {"title": title, "parts": html(parts), "anchor": anchor}


def _joined(*files: str) -> Markup:
    folder = templates_folder() / "report"
    return Markup("\n".join((folder / file).read_text(encoding="utf-8").rstrip() for file in files))
