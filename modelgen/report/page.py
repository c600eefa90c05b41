"""What the pages have in common: a template with style and script inside, and charts with their legend."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from modelgen.charts import Chart, drawn, labels
from modelgen.resources import templates_folder
from modelgen.version import __version__


@dataclass(frozen=True)
class Block:
    """Charts with one legend. charts: title and SVG; legend: role, label and whether it is dots."""

    charts: Sequence[tuple[str, Markup]]
    legend: Sequence[tuple[str, str, bool]] = ()
    zooms: bool = False


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


def inline(text: str) -> Markup:
    """A picture from its svg element on, which stands in the page as it is."""
    return Markup(text[text.index("<svg") :])
