"""The pictures of docs/diagnosis.md."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt

from hidden.effects import CATALOGUE, OUTSIDE
from hidden.tallies import Line, answered, of, wilson

SOFT = ("backlash, flexibility", "C1")  # label and colour


def _save(figure: Any, path: Path) -> None:
    with mpl.rc_context({"svg.hashsalt": "modelgen", "svg.fonttype": "none"}):
        figure.savefig(path, format="svg", metadata={"Date": None}, bbox_inches="tight")
    plt.close(figure)


def power(runs: dict[int, list[Line]], path: Path) -> None:
    """Curves of each number of training records; in grey single effects, with the fewest."""
    figure, axis = plt.subplots(figsize=(7.5, 4.2))
    for place, (train, lines) in enumerate(runs.items()):
        good = answered(lines)
        strengths = sorted({line["strength"] for line in of(good, "single")})
        for compliant, label, colour in ((False, "all other effects", "C0"), (True, *SOFT)):
            cells = [of(good, "single", strength, compliant) for strength in strengths]
            hits = [
                sum(line["by_class" if compliant else "result"] == "found" for line in cell) for cell in cells
            ]
            share = [100 * n / len(cell) if cell else math.nan for n, cell in zip(hits, cells, strict=True)]
            ends = [wilson(n, len(cell)) for n, cell in zip(hits, cells, strict=True)]
            below = [max(0.0, value - 100 * low) for value, (low, _) in zip(share, ends, strict=True)]
            above = [max(0.0, 100 * high - value) for value, (_, high) in zip(share, ends, strict=True)]
            axis.errorbar(
                [strength + 0.004 * place for strength in strengths],
                share,
                [below, above],
                marker="os^"[place % 3],
                linestyle=("-", "--", ":")[place % 3],
                capsize=4,
                color=colour,
                markerfacecolor="white" if compliant else colour,
                label=f"{label}, {train} training records",
            )
        for effect in CATALOGUE if not place else ():
            own = [[line for line in of(good, "single", s) if line["effects"] == [effect]] for s in strengths]
            hits = [sum(line["result"] == "found" for line in cell) for cell in own]
            curve = [100 * n / len(cell) if cell else math.nan for n, cell in zip(hits, own, strict=True)]
            axis.plot(strengths, curve, color="0.8", linewidth=0.7, zorder=0)
    axis.set(xlabel="strength s", ylabel="cause and joint found [%]", ylim=(-3, 103))
    if axis.get_legend_handles_labels()[0]:
        axis.legend(loc="lower right")
    axis.grid(alpha=0.3)
    _save(figure, path)


def confusion(lines: list[Line], path: Path) -> None:
    """What was named, by what was hidden."""
    rows = [*CATALOGUE, *OUTSIDE, "nothing"]
    columns = [*CATALOGUE, "nothing named"]
    counts = [[0.0] * len(columns) for _ in rows]
    for line in lines:
        if line["group"] not in ("null", "single", "outside"):
            continue
        row = rows.index(line["effects"][0] if line["effects"] else "nothing")
        answers = [name for name, _ in line["named"]] or ["nothing named"]
        for name in answers:
            if name in columns:
                counts[row][columns.index(name)] += 1.0 / len(answers)
    shares = [[value / max(1.0, sum(row)) for value in row] for row in counts]
    figure, axis = plt.subplots(figsize=(9.5, 9.5))
    axis.imshow(shares, cmap="Blues", vmin=0, vmax=1)
    for i, row in enumerate(counts):
        for j, value in enumerate(row):
            if value:
                colour = "white" if shares[i][j] > 0.6 else "black"
                axis.text(
                    j,
                    i,
                    f"{value:g}" if value % 1 == 0 else f"{value:.1f}",
                    ha="center",
                    va="center",
                    fontsize=7,
                    color=colour,
                )
    axis.set_xticks(range(len(columns)), columns, rotation=90, fontsize=8)
    axis.set_yticks(range(len(rows)), rows, fontsize=8)
    axis.set(xlabel="named", ylabel="hidden")
    _save(figure, path)
