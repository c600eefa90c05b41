"""Values with their intervals beside what was expected, one line each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

from modelgen.charts.ticks import anchored, ticks, written

WIDTH = 440
_LINE, _TOP, _BOTTOM = 19, 6, 40
_LETTER = 8.6  # width of a capital, as large as narrow screens have it [pixel]


@dataclass(frozen=True)
class Interval:
    """value: found, with its interval from low to high. expected: of the description, None where there is
    none.
    """

    name: str
    value: float
    low: float
    high: float
    expected: float | None = None


def intervals(rows: Sequence[Interval], x_label: str, text: str) -> str:
    """SVG: a dot with its interval for each value, a ring where it was expected.

    x_label: with the unit. text: what it shows, for who cannot see it.
    """
    ends = [x for r in rows for x in (r.low, r.high, r.value, r.expected) if x is not None]
    low, high = min([0.0, *ends]), max([0.0, *ends])
    room = 0.03 * (high - low) or 0.5
    low, high = low - room, high + room
    left = 12 + int(_LETTER * max(len(r.name) for r in rows))
    wide, height = WIDTH - left - 10, _TOP + _LINE * len(rows) + _BOTTOM

    def across(x: float) -> float:
        return left + (x - low) / (high - low) * wide

    bottom = height - _BOTTOM
    parts = [
        f'<svg class="chart rows" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" role="img"'
        f' aria-label="{escape(text)}">'
    ]
    places = ticks(low, high, 5)
    for value, word in zip(places, written(places), strict=True):
        strong = " zero" if abs(value) < 1e-9 * (high - low) else ""
        parts.append(f'<path class="grid{strong}" d="M{across(value):.1f} {_TOP}V{bottom}"/>')
        place = anchored(across(value), word, WIDTH)
        parts.append(f'<text class="tick" {place} y="{bottom + 15}">{word}</text>')
    for k, r in enumerate(rows):
        y = _TOP + _LINE * (k + 0.5)
        parts.append(
            f'<text class="tick" x="{left - 6}" y="{y + 4:.1f}" text-anchor="end">{escape(r.name)}</text>'
        )
        parts.append(f'<path class="span" d="M{across(r.low):.1f} {y:.1f}H{across(r.high):.1f}"/>')
        if r.expected is not None:
            parts.append(f'<circle class="ring" cx="{across(r.expected):.1f}" cy="{y:.1f}" r="5"/>')
        parts.append(f'<circle class="dot" cx="{across(r.value):.1f}" cy="{y:.1f}" r="3"/>')
    parts.append(f'<path class="frame" d="M{left} {bottom}h{wide}"/>')
    parts.append(
        f'<text class="label" x="{WIDTH - 10}" y="{height - 6}" text-anchor="end">{escape(x_label)}</text>'
        "</svg>"
    )
    return "".join(parts)
