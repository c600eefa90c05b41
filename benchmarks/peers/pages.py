"""docs/benchmarks.md and its pictures, from the figures of compare.py."""

# ruff: noqa: E501 - lines of the page
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from modelgen.figures import COLOURS, figure, svg

FUNCTIONS = ("inverse_dynamics", "mass_matrix", "forward_dynamics", "regressor")
_HEAD = """\
# Beside other tools

Written by `make bench`. Rigid links without drives and effects, the same 200 random states for everyone, results
compared to 1e-9 before anything is measured (regressors by the efforts that they give). x86-64-v3, `-O3`, double
precision, parameters folded in where the tool can. modelgen's figures hold its checks of the inputs.

- **instructions** per call, counted by callgrind, sine and cosine included; mean over the states. They do not
  depend on the load of the machine.
- **time**: CPU time as a ratio to modelgen's median in the same run; in brackets 10 to 90 % of blocks of calls.
- Pinocchio, C++: `rnea`, `crba`, `aba` (the convention with fewer instructions), `computeJointTorqueRegressor`,
  built from its headers. Its regressor has 10 n columns, modelgen's those of the base parameters.
- Pinocchio, traced with CasADi: the same algorithms on symbols, with CasADi's elimination of common
  subexpressions, as C.
- MuJoCo: `mj_inverse`, `mj_forward`, with all that these pipelines do besides.
- SymPy: `KanesMethod`, `cse`, C; two arms only, for its time.
"""


def document(result: dict[str, Any]) -> str:
    """docs/benchmarks.md."""
    versions = ", ".join(f"{name} {version}" for name, version in result["versions"].items())
    lines = [_HEAD, f"Measured with {versions}.", "", "![instructions relative to modelgen](benchmarks.svg)"]
    for arm, peers in result["arms"].items():
        lines += ["", f"## {arm}", "", "Instructions (ratio to modelgen).", ""]
        lines += _table(peers, _counts)
        lines += ["", "Time, ratio to modelgen.", ""]
        lines += _table(peers, _times)
    lines += ["", "## Generation and code", ""]
    lines += ["CPU seconds from the description to C of all functions; bytes of the four functions.", ""]
    lines += [
        "| arm | modelgen | bytes | traced Pinocchio | bytes | SymPy, Kane |",
        "|---|---:|---:|---:|---:|---:|",
    ]
    lines += [_made(arm, peers) for arm, peers in result["arms"].items()]
    lines += ["", "modelgen's time is for all of its functions, that of the others for four and for two.", ""]
    lines += ["## Regressor in many states", "", "Rows per second on one core, thousands.", ""]
    lines += _rates(result["rows_per_second"])
    return "\n".join(lines) + "\n"


def _table(peers: dict[str, Any], cell: Any) -> list[str]:
    lines = ["| | " + " | ".join(f.replace("_", " ") for f in FUNCTIONS) + " |", "|---|" + "---:|" * 4]
    for name, figures in peers.items():
        lines.append(f"| {name} | " + " | ".join(cell(figures, peers, f) for f in FUNCTIONS) + " |")
    return lines


def _counts(figures: dict[str, Any], peers: dict[str, Any], function: str) -> str:
    if function not in figures["instructions"]:
        return ""
    count = figures["instructions"][function]
    return f"{count:.0f} ({count / peers['modelgen']['instructions'][function]:.2f})"


def _times(figures: dict[str, Any], _: dict[str, Any], function: str) -> str:
    if function not in figures["time"]:
        return ""
    median, low, high = figures["time"][function]
    return f"{median:.2f} ({low:.2f}-{high:.2f})"


def _made(arm: str, peers: dict[str, Any]) -> str:
    ours = peers["modelgen"]
    four = [f"{f}_identified" for f in FUNCTIONS[:3]] + ["regressor"]
    cells = [arm, f"{ours['generation']:.2f}", str(sum(ours["bytes"][f] for f in four))]
    traced = peers.get("Pinocchio, traced with CasADi")
    cells += [f"{traced['generation']:.2f}", str(traced["bytes"]["all"])] if traced else ["", ""]
    kane = peers.get("SymPy, Kane")
    cells.append(f"{kane['generation']:.2f}" if kane else "")
    return "| " + " | ".join(cells) + " |"


def _rates(batches: dict[str, dict[str, float]]) -> list[str]:
    names = list(next(iter(batches.values()), {}))
    lines = ["| | " + " | ".join(names) + " |", "|---|" + "---:|" * len(names)]
    for arm, found in batches.items():
        lines.append(f"| {arm} | " + " | ".join(f"{found[name] / 1e3:.0f}" for name in names) + " |")
    return lines


def picture(result: dict[str, Any]) -> str:
    """Instructions relative to modelgen as SVG, one panel for each function."""
    arms = result["arms"]
    names = [n for n in dict.fromkeys(n for peers in arms.values() for n in peers) if n != "modelgen"]
    drawing, axes = figure(2, 2, (9.0, 6.0))
    for axis, function in zip(axes.ravel(), FUNCTIONS, strict=True):
        for k, name in enumerate(names):
            bars = {
                i: peers[name]["instructions"][function] / peers["modelgen"]["instructions"][function]
                for i, peers in enumerate(arms.values())
                if function in peers.get(name, {}).get("instructions", {})
            }
            where = np.array(list(bars)) + 0.16 * (k - (len(names) - 1) / 2)
            axis.bar(where, list(bars.values()), 0.15, color=COLOURS[k], label=name)
        axis.axhline(1.0, color="#222222", linewidth=0.8)
        axis.set_yscale("log", base=2)
        axis.yaxis.set_major_formatter("{x:g}")
        axis.set_title(function.replace("_", " "))
        axis.set_xticks(range(len(arms)), list(arms), rotation=30, ha="right")
        axis.set_ylabel("instructions / modelgen's")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    drawing.legend(handles, labels, loc="outside lower center", ncols=len(names), fontsize=8)
    return svg(drawing)


def write(result: dict[str, Any], folder: Path) -> None:
    """Write the page and its picture."""
    (folder / "benchmarks.svg").write_text(picture(result), encoding="utf-8")
    (folder / "benchmarks.md").write_text(document(result), encoding="utf-8")
