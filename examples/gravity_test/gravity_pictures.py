"""The pictures of the gravity test."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from modelgen.figures import COLOURS, figure, svg
from modelgen.simulation import Scores, Trajectory

Array = NDArray[np.float64]
Found = Mapping[tuple[str, int], Trajectory]


def link_1(found: Found, times: Mapping[tuple[str, int], float]) -> str:
    """Figures 9 to 11: the simulated curves, link 1 bare and carrying link 2, with their ends."""
    made, axes = figure(3, 1, (7.0, 6.6))
    for row, degrees in enumerate((20, 30, 40)):
        a = axes[row, 0]
        for name, text, colour, line in (
            ("gravity_link1_loaded", "carrying link 2", COLOURS[1], "-"),
            ("gravity_link1", "bare", COLOURS[4], "--"),
        ):
            run = found[name, degrees]
            a.plot(run.t, np.degrees(run.q[:, 0]), line, color=colour, label=f"link 1 {text}")
            at = times[name, degrees]
            if at <= run.t[-1]:
                a.axvline(at, color=colour, linewidth=0.8, linestyle=":")
        a.set_ylabel(f"q1 from {degrees} deg [deg]")
        a.set_title(f"Figure {9 + row}: rest after {_ends(times, degrees)}", loc="left", fontsize=9)
    axes[0, 0].legend(loc="upper right")
    axes[2, 0].set_xlabel("t [s], as long as measured")
    return svg(made)


def link_2(
    found: Found,
    held: Mapping[int, tuple[Array, Array, Scores, float]],
    times: Mapping[tuple[str, int], float],
) -> str:
    """Figures 12 to 14: the simulated curve on ten simulated measurements and their mean."""
    made, axes = figure(3, 1, (7.0, 6.6))
    for row, degrees in enumerate((20, 30, 40)):
        a = axes[row, 0]
        run = found["gravity_link2", degrees]
        runs, mean, fit, _ = held[degrees]
        a.plot(run.t, np.degrees(runs.T), color="#bbbbbb", linewidth=0.6)
        a.plot(run.t, np.degrees(mean), color=COLOURS[0], label="mean of ten, hidden spring and stiction")
        a.plot(
            run.t, np.degrees(run.q[:, 0]), "--", color=COLOURS[1], label="simulated, document's parameters"
        )
        a.axvline(times["gravity_link2", degrees], color=COLOURS[1], linewidth=0.8, linestyle=":")
        a.set_xlim(-0.1, 8.0)
        a.set_ylabel(f"q1 from {degrees} deg [deg]")
        scored = f"F_gof {fit.f_gof[0]:.1f} %, MAE {np.degrees(fit.mae[0]):.2f} deg over {run.t[-1]:g} s"
        a.set_title(f"Figure {12 + row}: {scored}", loc="left", fontsize=9)
    axes[0, 0].legend(loc="upper right")
    axes[2, 0].set_xlabel("t [s], the first 8 s: nothing moves after")
    return svg(made)


def _ends(times: Mapping[tuple[str, int], float], degrees: int) -> str:
    loaded, bare = times["gravity_link1_loaded", degrees], times["gravity_link1", degrees]
    return f"{loaded:.1f} s loaded, {bare:.1f} s bare"
