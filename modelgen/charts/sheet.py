"""Charts beside and below each other in one file, with their own style and legend."""

from __future__ import annotations

import re
from collections.abc import Sequence
from html import escape, unescape

from modelgen.charts.chart import Chart, labels
from modelgen.charts.drawn import HEIGHT, WIDTH, drawn
from modelgen.charts.paths import mark
from modelgen.resources import templates_folder

_LETTER, _LINE, _STRIP, _TITLE = 6.8, 18, 8, 18
_ENTRY = re.compile(r'<path class="(line|dots) (\w+)" d="[^"]*"/>\n<text class="label"[^>]*>([^<]*)</text>')


def sheet(charts: Sequence[Chart], columns: int, size: tuple[int, int] = (WIDTH, HEIGHT)) -> str:
    """SVG text that stands alone: rows of that many charts of `size` [pixel] below a legend."""
    style = (templates_folder() / "report" / "chart.css").read_text(encoding="utf-8")
    entries = labels(charts)
    wide, cell = size[0], size[1] + _TITLE
    width = wide * columns
    legend, lines = _legend(entries, width)
    strip = _STRIP + _LINE * lines
    height = strip + cell * -(-len(charts) // columns)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" class="sheet" viewBox="0 0 {width} {height}" '
        f'width="{width}" height="{height}">\n<style>\n{style}</style>',
        f'<rect class="paper" width="{width}" height="{height}"/>',
    ]
    parts += legend
    for k, chart in enumerate(charts):
        x, y = wide * (k % columns), strip + cell * (k // columns)
        parts.append(f'<text class="title" x="{x + 4}" y="{y + 12}">{escape(chart.title)}</text>')
        parts.append(
            f'<svg x="{x}" y="{y + _TITLE}" width="{wide}" height="{size[1]}">{drawn(chart, size)}</svg>'
        )
    return "\n".join([*parts, "</svg>"]) + "\n"


def chart_of(text: str) -> tuple[str, str, list[tuple[str, str, bool]]]:
    """Title, SVG and legend of the chart of a sheet that has one: what `sheet` was made of, for a page."""
    chart = text[text.index('<svg class="chart"') : text.rindex("</svg>")].rstrip().removesuffix("</svg>")
    title = re.search('class="title"[^>]*>([^<]*)<', text)
    legend = [(role, unescape(label), kind == "dots") for kind, role, label in _ENTRY.findall(text)]
    return unescape(title[1]) if title else "", chart, legend


def _legend(entries: Sequence[tuple[str, str, bool]], width: int) -> tuple[list[str], int]:
    """What was drawn, on as many lines as the width asks for; and how many those are."""
    parts, at, lines = [], 10.0, 1 if entries else 0
    for role, label, dotted in entries:
        room = 28 + _LETTER * len(label)
        if at > 10.0 and at + room > width:
            at, lines = 10.0, lines + 1
        y = _LINE * lines
        path = mark(role, at + 10, y - 4, 1.0) if dotted else f"M{at:g} {y - 4}h22"
        parts.append(f'<path class="{"dots" if dotted else "line"} {role}" d="{path}"/>')
        parts.append(f'<text class="label" x="{at + 28:g}" y="{y}">{escape(label)}</text>')
        at += room + 22
    return parts, lines
