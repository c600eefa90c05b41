"""The pictures: same input, same bytes, but for the solve times."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from mpc_arm import ControlledArm
from mpc_loop import Run

if TYPE_CHECKING:
    from mpc_timing import Timing

BLUE, ORANGE, GREEN, GREY, RED = "#0b5fa5", "#d1620a", "#2f8f4e", "#777777", "#b3202c"
STYLE: dict[Any, Any] = {
    "svg.hashsalt": "modelgen",
    "svg.fonttype": "path",
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.alpha": 0.25,
    "lines.linewidth": 1.3,
    "figure.facecolor": "white",
}
JOINTS = ("joint 1", "joint 2", "joint 3")


def draw(folder: Path, arm: ControlledArm, runs: Mapping[str, Run], timings: Sequence[Timing]) -> None:
    """Write tracking.svg, error.svg and solve_times.svg."""
    mpl.use("Agg")
    with mpl.rc_context(STYLE):
        _save(_tracking(arm, runs["wrong"]), folder / "tracking.svg")
        _save(_errors(runs), folder / "error.svg")
        _save(_times(timings), folder / "solve_times.svg")


def _tracking(arm: ControlledArm, run: Run) -> Any:
    assert arm.drives is not None
    figure, axes = plt.subplots(3, 3, figsize=(9.5, 6.2), sharex=True, layout="constrained")
    n = arm.n
    for j in range(n):
        angle, current, stroke = axes[:, j]
        angle.set_title(JOINTS[j])
        angle.plot(run.t, np.rad2deg(run.reference[:, j]), "--", color=GREY, label="reference")
        angle.plot(run.t, np.rad2deg(run.states[:, j]), color=BLUE, label="arm")
        current.step(run.t[:-1], run.inputs[:, j], where="post", color=ORANGE)
        for sign in (-1, 1):
            current.axhline(sign * arm.effort[j], color=RED, linestyle=":")
        current.set_ylim(-1.25 * arm.effort[j], 1.25 * arm.effort[j])
        span = arm.drives.high[j] - arm.drives.low[j]
        stroke.plot(run.t, 100 * (run.motor[:, j] - arm.drives.low[j]) / span, color=GREEN)
        for end in (0, 100):
            stroke.axhline(end, color=RED, linestyle=":")
        stroke.set_ylim(-8, 108)
        stroke.set_xlabel("time [s]")
    axes[0, 0].set_ylabel("angle [deg]")
    axes[1, 0].set_ylabel("motor current [A]")
    axes[2, 0].set_ylabel("actuator stroke [%]")
    axes[0, 0].legend(frameon=False, loc="upper left")
    axes[1, 0].annotate("limit", (23.9, arm.effort[0]), ha="right", va="bottom", color=RED)
    axes[2, 0].annotate("end of stroke", (0.1, 100), ha="left", va="bottom", color=RED)
    figure.suptitle(
        "MPC of the levered arm, parameters wrong by up to 10 %: joint 1 is asked for more than its stroke",
        fontsize=10,
    )
    return figure


def _errors(runs: Mapping[str, Run]) -> Any:
    labels = {
        "wrong": ("parameters wrong by up to 10 %", ORANGE, "-"),
        "exact": ("exact parameters", BLUE, "--"),
        "smoothed": ("exact parameters, dry friction smooth in the plant too", GREEN, ":"),
    }
    figure, axes = plt.subplots(1, 3, figsize=(9.5, 2.9), layout="constrained")
    for j, axis in enumerate(axes):
        axis.set_title(JOINTS[j])
        for name, (label, colour, line) in labels.items():
            error = np.rad2deg(runs[name].error[:, j])
            axis.plot(runs[name].t, error, line, color=colour, label=label, linewidth=1.1)
        axis.set_xlabel("time [s]")
    axes[0].set_ylabel("angle less reference [deg]")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    return figure


def _times(timings: Sequence[Timing]) -> Any:
    ordered = sorted(timings, key=lambda t: float(np.median(t.cpu)), reverse=True)
    unit = min(float(np.median(t.cpu)) for t in timings)
    figure, axis = plt.subplots(figsize=(7.5, 3.2), layout="constrained")
    for row, t in enumerate(ordered):
        low, middle, high = np.quantile(t.cpu, [0.1, 0.5, 0.9]) / unit
        colour = BLUE if t.formulation == "inverse" else ORANGE
        axis.barh(row, middle, color=colour, alpha=1.0 if t.jit else 0.45, height=0.65)
        axis.plot([low, high], [row, row], color="black", linewidth=1)
        axis.annotate(f"{middle:.1f}", (high, row), xytext=(5, 0), textcoords="offset points", va="center")
    axis.set_yticks(range(len(ordered)), [t.name for t in ordered])
    axis.set_xscale("log")
    axis.set_xlim(left=0.5)
    axis.grid(visible=False, axis="y")
    axis.set_xlabel("CPU time per plan, as a multiple of the fastest (median; line: 10 to 90 %)")
    return figure


def _save(figure: Any, path: Path) -> None:
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)
