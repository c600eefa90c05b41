"""What the pages have in common: a template with style and script inside, and charts with their legend."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from modelgen.charts import Chart, Interval, drawn, intervals, labels
from modelgen.resources import templates_folder
from modelgen.version import __version__


@dataclass(frozen=True)
class Text:
    """A paragraph. look: class of its style."""

    text: str
    look: str = ""
    kind: str = "text"


@dataclass(frozen=True)
class Command:
    """A command to copy."""

    text: str
    kind: str = "command"


@dataclass(frozen=True)
class Lines:
    """A list."""

    lines: Sequence[str]
    kind: str = "list"


@dataclass(frozen=True)
class Grid:
    """A table. heads: each with the side that its cells stand at."""

    caption: str
    heads: Sequence[tuple[str, str]]
    rows: Sequence[Sequence[str]]
    kind: str = "table"


@dataclass(frozen=True)
class Block:
    """Charts with one legend. charts: title and SVG; legend: role, label and whether it is dots."""

    charts: Sequence[tuple[str, Markup]]
    legend: Sequence[tuple[str, str, bool]] = ()
    zooms: bool = False
    kind: str = "charts"


@dataclass(frozen=True)
class Folded:
    """What is folded away until it is asked for. screen: not on paper."""

    title: str
    parts: Sequence[Any]
    screen: bool = False
    kind: str = "folded"


Parts = Sequence[tuple[str, Sequence[Any]]]  # headings, each with what stands below it


def page(title: str, task: str, answers: Parts, sections: Parts) -> str:
    """HTML of a result: questions with their answers, which the first screen shows, then sections."""
    return rendered("page.html.j2", title=title, task=task, answers=answers, sections=sections)


def block(charts: Sequence[Chart]) -> Block:
    """Drawn charts that stand beside and below each other."""
    return Block([(c.title, Markup(drawn(c))) for c in charts], labels(charts), any(c.zoom for c in charts))


def rendered(name: str, **values: Any) -> str:
    """HTML of a page of `templates/report` that needs nothing beside it."""
    folder = templates_folder()
    environment = Environment(
        loader=FileSystemLoader(folder),
        undefined=StrictUndefined,
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
    )

    def text(file: str) -> str:
        return (folder / "report" / file).read_text(encoding="utf-8").rstrip()

    page = environment.get_template(f"report/{name}").render(
        style=Markup(text("chart.css") + "\n" + text("page.css")),
        script=Markup(text("page.js")),
        version=__version__,
        **values,
    )
    return "\n".join(line.rstrip() for line in page.splitlines() if line.strip()) + "\n"


def pictured(rows: Sequence[Interval], x_label: str, text: str, title: str = "") -> tuple[str, Markup]:
    """Values with their intervals as one of the charts of a block."""
    return title, Markup(intervals(rows, x_label, text))


def inline(text: str) -> Markup:
    """A picture from its svg element on, which stands in the page as it is."""
    return Markup(text[text.index("<svg") :])
