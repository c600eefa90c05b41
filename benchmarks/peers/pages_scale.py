"""The section on growth, and its picture."""

# ruff: noqa: E501 - lines of the page
from __future__ import annotations

from math import log
from typing import Any

from modelgen.figures import COLOURS, figure, svg
from peers.tables import FUNCTIONS

_HEAD = """\
## Growth

Written by `python benchmarks/scale.py --accept`. Chains of revolute joints with parallel and perpendicular axes, and
two trees of 30 bodies (`binary`: every link carries two; `limbs`: a waist with limbs of six); parameters folded in,
x86-64-v3, `-O3`. modelgen's generation writes all of its functions, with parameters at run time and folded in; the
trace's figure is the sum of the four functions. What takes the compiler or the tracer more than {limit} s of CPU time is
left out. Exponent: log of the ratio over log of the ratio of joints, from the arm before.

Forward dynamics: modelgen takes the cheaper of the mass matrix with its solution, of the order of the cube of a chain's
length, and of articulated bodies (Featherstone 2008), of the order of its length: the latter from about ten joints on.

Solid: modelgen; dashed: the trace; crosses: modelgen, the trees.

![growth with the number of joints](benchmarks-scale.svg)
"""


def lines(result: dict[str, Any]) -> list[str]:
    """Lines of the section."""
    text = [_HEAD.format(limit=result["limit"])]
    text += [line for remark in result.get("remarks", ()) for line in (remark, "")]
    text += ["| | generation, s (exponent) | memory, MB | trace, s |", "|---|---:|---:|---:|"]
    before: tuple[int, float] | None = None
    for name, arm in result["arms"].items():
        cost = arm["modelgen"]["generation"]
        growth = ""
        if arm["shape"] == "chain":
            if before:
                growth = f" ({log(cost['seconds'] / before[1]) / log(arm['joints'] / before[0]):.1f})"
            before = arm["joints"], cost["seconds"]
        made = arm.get("traced", {}).get("functions", {})
        traced = f"{sum(f['generation'] for f in made.values()):.2f}" if len(made) == len(FUNCTIONS) else ""
        text.append(f"| {name} | {cost['seconds']:.2f}{growth} | {cost['memory']:.0f} | {traced} |")
    for title, key in (
        ("Instructions per call: modelgen, traced Pinocchio, ratio.", "instructions"),
        ("Bytes of code: modelgen, traced Pinocchio, ratio.", "code"),
        ("CPU seconds of gcc: modelgen, traced Pinocchio.", "compilation"),
    ):
        text += ["", title, "", "| | " + " | ".join(f.replace("_", " ") for f in FUNCTIONS) + " |"]
        text += ["|---|" + "---:|" * len(FUNCTIONS)]
        for name, arm in result["arms"].items():
            text.append(f"| {name} | " + " | ".join(_pair(arm, f, key) for f in FUNCTIONS) + " |")
    return text


def _pair(arm: dict[str, Any], function: str, key: str) -> str:
    ours, theirs = (arm.get(who, {}).get("functions", {}).get(function) for who in ("modelgen", "traced"))
    digits = 1 if key == "compilation" else 0
    cells = [f"{made[key]:.{digits}f}" if made else "-" for made in (ours, theirs)]
    if ours and theirs and key != "compilation":
        cells.append(f"{theirs[key] / ours[key]:.2f}")
    return ", ".join(cells)


def picture(result: dict[str, Any]) -> str:
    """Generation, instructions, code and compilation of the chains on logarithmic axes, trees as crosses."""
    drawing, axes = figure(2, 2, (9.0, 7.5))
    chains = [arm for arm in result["arms"].values() if arm["shape"] == "chain"]
    trees = [arm for arm in result["arms"].values() if arm["shape"] != "chain"]
    generation = axes[0, 0]
    for who, style in (("modelgen", "-"), ("traced", "--")):
        points = [(arm["joints"], _generation(arm, who)) for arm in chains]
        kept = [(n, y) for n, y in points if y]
        label = "modelgen, all functions" if who == "modelgen" else "traced Pinocchio, four functions"
        generation.plot(
            *zip(*kept, strict=True),
            style,
            marker="o",
            markersize=3,
            color=COLOURS[who != "modelgen"],
            label=label,
        )
    generation.plot(
        [a["joints"] for a in trees], [_generation(a, "modelgen") for a in trees], "x", color=COLOURS[0]
    )
    generation.set_ylabel("generation [s CPU]")
    generation.legend(fontsize=7)
    panels = {
        "instructions": "instructions per call",
        "code": "code [bytes]",
        "compilation": "gcc -O3 [s CPU]",
    }
    for axis, (key, title) in zip(axes.ravel()[1:], panels.items(), strict=True):
        for k, function in enumerate(FUNCTIONS):
            for who, style in (("modelgen", "-"), ("traced", "--")):
                found = [(a["joints"], a.get(who, {}).get("functions", {}).get(function)) for a in chains]
                kept = [(n, made[key]) for n, made in found if made]
                if not kept:
                    continue
                name = function.replace("_", " ")
                label = name if who == "modelgen" else f"{name}, traced"
                axis.plot(
                    *zip(*kept, strict=True), style, marker="o", markersize=3, color=COLOURS[k], label=label
                )
            marks = [(a["joints"], a["modelgen"]["functions"].get(function)) for a in trees]
            for n, made in marks:
                if made:
                    axis.plot([n], [made[key]], "x", color=COLOURS[k])
        axis.set_ylabel(title)
    for axis in axes.ravel():
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.set_xticks([2, 3, 5, 10, 20, 30, 50], ["2", "3", "5", "10", "20", "30", "50"])
        axis.set_xticks([], minor=True)
        axis.set_xlabel("joints")
    handles, labels = axes[0, 1].get_legend_handles_labels()
    drawing.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=7)
    return svg(drawing)


def _generation(arm: dict[str, Any], who: str) -> float | None:
    if who == "modelgen":
        return float(arm["modelgen"]["generation"]["seconds"])
    made = arm.get("traced", {}).get("functions", {})
    return sum(f["generation"] for f in made.values()) if len(made) == len(FUNCTIONS) else None
