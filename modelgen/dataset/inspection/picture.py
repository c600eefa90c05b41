"""A picture of a log: its channels over time, and the time between samples."""

from __future__ import annotations

import numpy as np

from modelgen.dataset.inspection.channels import Inspected
from modelgen.figures import COLOURS, figure, svg
from modelgen.numeric import Array

PANELS = 24  # channels that are drawn, at most
POINTS = 600  # pairs of lowest and highest readings of a curve: the picture stays small


def inspection_svg(found: Inspected) -> str:
    """The picture as SVG text, the same in every run: a panel for each channel, the last for the stamps."""
    # as every axis of time: stamps of a clock have ten digits
    t, named = found.t - found.t[0], [c for c in found.channels if c.name in found.columns][:PANELS]
    rows = (len(named) + 2) // 2
    made, grid = figure(rows, 2, (10.0, 1.5 * rows + 0.5))
    panels = grid.ravel()
    for axes, channel in zip(panels, named, strict=False):
        values = found.columns[channel.name]
        axes.plot(*_envelope(t, values), color=COLOURS[0], linewidth=0.7)
        unit = channel.unit or (f"{channel.guess}?" if channel.guess else "")
        axes.set_ylabel(f"{channel.name}\n[{unit}]" if unit else channel.name)
    axes = panels[len(named)]
    axes.plot(*_envelope(t[1:], 1e3 * np.diff(t)), color=COLOURS[1], linewidth=0.7)
    axes.set_ylabel("time between\nsamples [ms]")
    axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))  # what varies is seen against the period
    axes.margins(y=0.2)
    for axes in panels[len(named) + 1 :]:
        axes.set_axis_off()
    for axes in panels[max(0, len(named) - 1) : len(named) + 1]:
        axes.set_xlabel("time [s]")
    return svg(made)


def _envelope(t: Array, values: Array) -> tuple[Array, Array]:
    """Lowest and highest reading of each of a number of pieces, in order: no spike is lost."""
    if len(values) <= 2 * POINTS:
        return t, values
    pieces = np.array_split(np.arange(len(values)), POINTS)
    safe = np.where(np.isfinite(values), values, np.inf)
    low = [int(p[0] + np.argmin(safe[p])) for p in pieces]
    high = [int(p[0] + np.argmax(np.where(np.isfinite(values[p]), values[p], -np.inf))) for p in pieces]
    chosen = np.sort(np.array([low, high]), axis=0).T.ravel()
    return t[chosen], values[chosen]
