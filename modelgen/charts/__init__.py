"""Charts as SVG: light enough to draw by the dozen, legible at any width, in the colours of their page."""

from modelgen.charts.chart import ROLES, Band, Chart, Curve, labels, over_time, within
from modelgen.charts.drawn import drawn
from modelgen.charts.intervals import Interval, intervals
from modelgen.charts.paths import mark
from modelgen.charts.sheet import chart_of, sheet
from modelgen.charts.ticks import apart, at_joints, in_percent, known, number, sized, ticks

__all__ = [
    "ROLES",
    "Band",
    "Chart",
    "Curve",
    "Interval",
    "apart",
    "at_joints",
    "chart_of",
    "drawn",
    "in_percent",
    "intervals",
    "known",
    "labels",
    "mark",
    "number",
    "over_time",
    "sheet",
    "sized",
    "ticks",
    "within",
]
