"""Charts beside and below each other in one file, with their own style and legend."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from modelgen.charts.chart import Chart, labels
from modelgen.charts.drawn import HEIGHT, WIDTH, drawn
from modelgen.resources import templates_folder

_LETTER, _STRIP, _TITLE = 6.8, 26, 18


def sheet(charts: Sequence[Chart], columns: int) -> str:
    """SVG text that stands alone: rows of that many charts below a legend."""
    style = (templates_folder() / "report" / "chart.css").read_text(encoding="utf-8")
    entries = labels(charts)
    cell = HEIGHT + _TITLE
    height = _STRIP + cell * -(-len(charts) // columns)
    width = WIDTH * columns
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" class="sheet" viewBox="0 0 {width} {height}" '
        f'width="{width}" height="{height}">\n<style>\n{style}</style>',
        f'<rect class="paper" width="{width}" height="{height}"/>',
    ]
    at = 10.0
    for role, label, dotted in entries:
        kind = "dots" if dotted else "line"
        parts.append(
            f'<path class="{kind} {role}" d="M{at + (10 if dotted else 0):g} 14h{0 if dotted else 22}"/>'
        )
        parts.append(f'<text class="label" x="{at + 28:g}" y="18">{escape(label)}</text>')
        at += 28 + _LETTER * len(label) + 22
    for k, chart in enumerate(charts):
        x, y = WIDTH * (k % columns), _STRIP + cell * (k // columns)
        parts.append(f'<text class="title" x="{x + 4}" y="{y + 12}">{escape(chart.title)}</text>')
        parts.append(f'<svg x="{x}" y="{y + _TITLE}" width="{WIDTH}" height="{HEIGHT}">{drawn(chart)}</svg>')
    return "\n".join([*parts, "</svg>"]) + "\n"
