"""Pictures as SVG text, the same bytes for the same data."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = ("#1f5fa8", "#d1661a", "#3a8f4d", "#8a4fa3", "#666666")
_STYLE: Any = {
    "svg.hashsalt": "modelgen",
    "svg.fonttype": "none",  # text stays text: to be searched, and no fonts inside
    "font.size": 9,
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.2,
    "axes.formatter.useoffset": False,
    "legend.frameon": False,
}


def figure(rows: int = 1, columns: int = 1, size: tuple[float, float] = (7.0, 3.0)) -> tuple[Figure, Any]:
    """A figure of `size` [inch] and its axes as a rows x columns array."""
    # Matplotlib takes long to load, and is needed last of all.
    from matplotlib import rc_context  # noqa: PLC0415
    from matplotlib.figure import Figure  # noqa: PLC0415

    with rc_context(_STYLE):
        made = Figure(figsize=size, layout="constrained")
        axes = made.subplots(rows, columns, squeeze=False)
    return made, axes


def svg(made: Figure) -> str:
    """The figure as SVG, without date."""
    from matplotlib import rc_context  # noqa: PLC0415

    out = io.StringIO()
    with rc_context(_STYLE):
        layout = made.get_layout_engine()
        if layout is not None:
            layout.execute(made)  # twice, with that of the drawing: the first one may move the ticks
        made.savefig(out, format="svg", metadata={"Date": None, "Creator": None})
    return "\n".join(line.rstrip() for line in out.getvalue().splitlines()) + "\n"
