"""Pictures of the comparison."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from modelgen.figures import COLOURS, figure, svg

_OURS = "modelgen"
_HATCHES = ("", "//////", "xxxx", "------")  # of bars, for paper without colours
_COLOURS = (*COLOURS, "#b8860b", "#20a0a0")


def pictures(arms: dict[str, Any], functions: Sequence[str]) -> dict[str, str]:
    """SVG by file name."""
    return {"benchmarks.svg": _instructions(arms, functions), "benchmarks-costs.svg": _costs(arms)}


def _instructions(arms: dict[str, Any], functions: Sequence[str]) -> str:
    """Instructions relative to modelgen, one panel for each function, a mark for each tool."""
    names = [n for n in dict.fromkeys(n for peers in arms.values() for n in peers) if n != _OURS]
    drawing, axes = figure(len(functions), 1, (9.0, 11.0))
    for axis, function in zip(axes.ravel(), functions, strict=True):
        for k, name in enumerate(names):
            marks = {
                i: peers[name]["instructions"][function] / peers[_OURS]["instructions"][function]
                for i, peers in enumerate(arms.values())
                if function in peers.get(name, {}).get("instructions", {})
            }
            style = {"marker": "osD^vPX"[k % 7], "linestyle": "none", "color": _COLOURS[k % 7]}
            axis.plot(list(marks), list(marks.values()), label=name, markersize=5, **style)
        axis.axhline(1.0, color="#222222", linewidth=0.8)
        axis.set_yscale("log", base=2)
        axis.yaxis.set_major_formatter("{x:g}")
        axis.set_title(function.replace("_", " "))
        axis.set_xticks(range(len(arms)), list(arms), rotation=30, ha="right")
        axis.set_ylabel("instructions / modelgen's")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    drawing.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=8)
    return svg(drawing)


def _costs(arms: dict[str, Any]) -> str:
    """Generation time, its memory and the code's bytes."""
    panels = {
        "generation [s CPU]": "seconds",
        "generation, most memory [MB]": "memory",
        "code and constants [bytes]": "code",
    }
    names = ["modelgen", "Pinocchio, traced with CasADi", "SymForce", "SymPy, Kane"]
    drawing, axes = figure(len(panels), 1, (9.0, 8.0))
    for axis, (title, key) in zip(axes.ravel(), panels.items(), strict=True):
        for k, name in enumerate(names):
            found = {
                i: cost[key] + (cost["tables"] if key == "code" else 0)
                for i, peers in enumerate(arms.values())
                if key in (cost := peers.get(name, {}).get("costs", {}))
            }
            where = np.array(list(found)) + 0.2 * (k - (len(names) - 1) / 2)
            look = {"color": _COLOURS[k], "edgecolor": "white", "linewidth": 0, "hatch": _HATCHES[k]}
            axis.bar(where, list(found.values()), 0.18, label=name, **look)
        axis.set_yscale("log")
        axis.set_ylabel(title)
        axis.set_xticks(range(len(arms)), list(arms), rotation=30, ha="right")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    drawing.legend(handles, labels, loc="outside lower center", ncols=len(names), fontsize=8)
    return svg(drawing)
