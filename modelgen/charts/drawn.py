"""A chart as an SVG element, whose classes are styled by the page around it."""

from __future__ import annotations

from html import escape

import numpy as np

from modelgen.charts.chart import Chart
from modelgen.charts.paths import dots, line
from modelgen.charts.ticks import anchored, ticks, written
from modelgen.numeric import Array

WIDTH, HEIGHT = 440, 220
_TOP, _BOTTOM, _RIGHT = 22, 36, 8
_LETTER = 6.6  # width of a digit [pixel]
_TOUCH = 1e-9


def drawn(chart: Chart, size: tuple[int, int] = (WIDTH, HEIGHT)) -> str:
    """SVG text of WIDTH x HEIGHT pixels in its own units; the page gives it its width.

    Numbers and labels stand outside the frame of the curves, the ordinate's label above it.
    """
    width, height = size
    (x0, x1), (y0, y1) = chart.spans()
    y_ticks, y_words = _ticks(chart, y0, y1, 4)
    left = 10 + int(_LETTER * max((len(w) for w in y_words), default=1))
    wide, high = width - left - _RIGHT, height - _TOP - _BOTTOM

    def across(x: Array) -> Array:
        return np.asarray((x - x0) / (x1 - x0) * wide)

    def down(y: Array) -> Array:
        return np.asarray((y1 - np.clip(y, y0 - (y1 - y0), y1 + (y1 - y0))) / (y1 - y0) * high)

    zoomed = f' data-zoom="{x0:.9g} {x1:.9g} {left} {wide}"' if chart.zoom else ""
    parts = [
        f'<svg class="chart" viewBox="0 0 {width} {height}" width="{width}" height="{height}" role="img"'
        f' aria-label="{escape(chart.text or chart.title)}"{zoomed}>'
    ]
    for value, word in zip(y_ticks, y_words, strict=True):
        at = _TOP + float(down(np.array(value)))
        strong = " zero" if not chart.logarithmic and abs(value) < _TOUCH * (y1 - y0) else ""
        parts.append(f'<path class="grid{strong}" d="M{left} {at:.1f}h{wide}"/>')
        parts.append(f'<text class="tick" x="{left - 5}" y="{at + 4:.1f}" text-anchor="end">{word}</text>')
    parts.append('<g class="abscissa">')
    for value, word in zip(*_ticks(chart, x0, x1, 6), strict=True):
        at = left + float(across(np.array(value)))
        parts.append(f'<path class="grid" d="M{at:.1f} {_TOP}v{high}"/>')
        parts.append(f'<text class="tick" {anchored(at, word, width)} y="{_TOP + high + 15}">{word}</text>')
    parts.append("</g>")
    parts.append(f'<svg x="{left}" y="{_TOP}" width="{wide}" height="{high}"><g class="curves">')
    for band in chart.bands:
        top, bottom = (float(down(np.array(v))) for v in (band.high, band.low))
        parts.append(
            f'<rect class="band" x="0" y="{top:.1f}" width="{wide}" height="{max(bottom - top, 0.5):.1f}"/>'
        )
    for curve in chart.curves:
        x, y = across(chart.along(curve.x)), down(chart.along(curve.y))
        path = dots(x, y, curve.role) if curve.dots else line(x, y)
        kind = "dots" if curve.dots else "line"
        parts.append(f'<path class="{kind} {curve.role}" transform="scale(.1)" d="{path}"/>')
    parts.append("</g></svg>")
    parts.append(f'<path class="frame" d="M{left} {_TOP}v{high}h{wide}"/>')
    parts.append(f'<text class="label" x="{2}" y="13">{escape(chart.y_label)}</text>')
    parts.append(
        f'<text class="label" x="{width - _RIGHT}" y="{height - 4}" text-anchor="end">'
        f"{escape(chart.x_label)}</text></svg>"
    )
    return "".join(parts)


def _ticks(chart: Chart, low: float, high: float, about: int) -> tuple[list[float], list[str]]:
    """Places along an axis and what is written there: of a logarithmic one whole powers of ten."""
    if not chart.logarithmic:
        places = ticks(low, high, about)
        return places, written(places)
    places = [p for p in ticks(low, high, about) if abs(p - round(p)) < _TOUCH]
    return places, [f"{10.0 ** round(p):g}" for p in places]
