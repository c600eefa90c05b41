"""What a chart shows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from modelgen.numeric import Array

# What a curve is decides its look: colour, width and dashes stand in the style of the page.
ROLES = ("measured", "before", "after", "law", "noise", "s0", "s1", "s2", "s3", "s4", "s5", "s6")

_BESIDE = 0.02  # of the span of the abscissae, beside dots


@dataclass(frozen=True)
class Curve:
    """x, y: (N,), not a number where the line is broken. role: one of ROLES. dots: points without a line."""

    x: Array
    y: Array
    role: str
    label: str = ""
    dots: bool = False


@dataclass(frozen=True)
class Band:
    """A strip over the whole width between two ordinates."""

    low: float
    high: float
    label: str = ""


@dataclass(frozen=True)
class Chart:
    """One panel. x_label, y_label: with the unit in brackets. text: what it shows, for who cannot see it.

    zoom: the page lets its abscissa be enlarged. y_range: of the ordinate; by default what the curves span.
    logarithmic: both axes are.
    """

    title: str
    x_label: str
    y_label: str
    curves: Sequence[Curve]
    text: str = ""
    bands: Sequence[Band] = ()
    zoom: bool = False
    y_range: tuple[float, float] | None = None
    logarithmic: bool = False

    def spans(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Lowest and highest abscissa and ordinate of what is finite, apart where they are one."""
        x = [self.along(c.x) for c in self.curves]
        y = [self.along(c.y) for c in self.curves] + [np.array([b.low, b.high]) for b in self.bands]
        limits = None if self.y_range is None else self.along(np.array(self.y_range))
        # Of dots, the first and the last are drawn whole.
        beside = _BESIDE if any(c.dots for c in self.curves) and not self.zoom else 0.0
        return _span(x, beside), _span(y, 0.05) if limits is None else (float(limits[0]), float(limits[1]))

    def along(self, values: Array) -> Array:
        """Where values (N,) lie along an axis: themselves, or their decimal logarithms."""
        if not self.logarithmic:
            return np.asarray(values, dtype=float)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(np.log10(values))


def over_time(
    title: str, y_label: str, curves: Sequence[Curve], text: str, begin: float, **others: Any
) -> Chart:
    """A chart over time [s] since `begin`, whatever the stamps count from: those of a clock have ten digits.

    The curves have the stamps as abscissae. others: further fields of the chart.
    """
    since = [replace(c, x=c.x - begin) for c in curves]
    return Chart(title, "time [s]", y_label, since, text, **others)


def within(curves: Sequence[Curve], low: float, high: float) -> tuple[float, float] | None:
    """Ordinates that a chart shows of curves that leave the limits low and high, with room; None where none
    does: of a simulated motion that runs away as much is drawn as leaves the measured one legible.
    """
    lowest, highest = (f([f(c.y[np.isfinite(c.y)]) for c in curves]) for f in (np.min, np.max))
    if (low <= lowest and highest <= high) or not low < high:
        return None
    room = 0.05 * (high - low)
    return max(float(lowest), low) - room, min(float(highest), high) + room


def labels(charts: Sequence[Chart]) -> list[tuple[str, str, bool]]:
    """Role, label and whether it is dots of everything that has a label, once each."""
    found: dict[tuple[str, str, bool], None] = {}
    for chart in charts:
        for band in chart.bands:
            if band.label:
                found["noise", band.label, False] = None
        for curve in chart.curves:
            if curve.label:
                found[curve.role, curve.label, curve.dots] = None
    return list(found)


def _span(values: Sequence[Array], margin: float) -> tuple[float, float]:
    every = np.concatenate([np.ravel(v) for v in values]) if values else np.zeros(0)
    finite = every[np.isfinite(every)]
    if not len(finite):
        return 0.0, 1.0
    low, high = float(finite.min()), float(finite.max())
    if high - low <= 1e-12 * max(abs(low), abs(high)):
        half = 0.5 * abs(low) or 0.5
        return low - half, high + half
    return low - margin * (high - low), high + margin * (high - low)
