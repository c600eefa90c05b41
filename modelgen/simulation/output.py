"""A simulated motion as data, as a table and as a picture."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from typing import Any

import numpy as np

from modelgen.backends import NumpyFunction
from modelgen.figures import COLOURS, figure, svg
from modelgen.numeric import Array
from modelgen.simulation.metrics import Scores
from modelgen.simulation.plant import Plant
from modelgen.simulation.tables import input_names
from modelgen.simulation.trajectory import Trajectory


def facts(p: Plant, found: Trajectory) -> dict[str, Any]:
    """Facts of a motion: where it ended, when it came to rest, what became of its energy."""
    moving = np.flatnonzero((found.dq != 0).any(axis=1))
    last = int(moving[-1]) if len(moving) else -1
    rest = last + 1 < len(found.t)
    energy = _energy(p, found)
    return {
        "arm": p.arm.name,
        "samples": len(found.t),
        "duration": float(found.t[-1]),
        "q_end": found.q[-1].tolist(),
        "dq_end": found.dq[-1].tolist(),
        "at_rest_from": float(found.t[last + 1]) if rest else None,
        "energy": {"begin": energy[0], "end": energy[1], "unit": "J"},
        "ended": found.ended or None,
    }


def _energy(p: Plant, found: Trajectory) -> tuple[float, float]:
    function = NumpyFunction(p.model.function("energy"))
    ends = []
    for k in (0, -1):
        given = {
            "q": found.q[k],
            "dq": found.dq[k],
            "parameters": p.base,
            "state": found.states[k],
            "time": np.array([found.t[k]]),
        }
        names = [a.name for a in function.function.arguments]
        kinetic, potential = function(**{name: given.get(name, np.zeros(p.n)) for name in names})
        ends.append(float(kinetic[0] + potential[0]))
    return ends[0], ends[1]


def joint_scores(p: Plant, s: Scores) -> list[dict[str, Any]]:
    """F_gof [%], MAE and RMSE [rad, m] by joint."""

    def number(x: float) -> float | None:
        return float(x) if np.isfinite(x) else None

    return [
        {
            "joint": k + 1,
            "f_gof_percent": number(s.f_gof[k]),
            "mae": number(s.mae[k]),
            "rmse": number(s.rmse[k]),
            "unit": unit,
        }
        for k, unit in enumerate(p.arm.coordinate_units)
    ]


def table(p: Plant, t: Array, q: Array, dq: Array, inputs: Array | None) -> str:
    """CSV: t [s], q, dq (S, n) [rad, m; /s] and, where there are any, the inputs (S, n) [A; N m, N]."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    names = ["t", *(f"q{k + 1}" for k in range(p.n)), *(f"dq{k + 1}" for k in range(p.n))]
    columns = [t, q, dq] if inputs is None else [t, q, dq, inputs]
    writer.writerow(names if inputs is None else [*names, *input_names(p)])
    writer.writerows([f"{x:.12g}" for x in row] for row in np.column_stack(columns))
    return text.getvalue()


def log_table(log: Mapping[str, Array]) -> str:
    """CSV of a log's columns (S,)."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(log)
    writer.writerows([f"{x:.12g}" for x in row] for row in np.column_stack(list(log.values())))
    return text.getvalue()


def picture(p: Plant, t: Array, q: Array, dq: Array, measured: Array | None) -> str:
    """Position and speed of every joint over time, as SVG."""
    t = t - t[0]  # as every axis of time
    made, axes = figure(p.n, 2, (9.0, 1.7 * p.n + 0.3))
    for k, (name, unit) in enumerate(zip(p.names, p.arm.coordinate_units, strict=True)):
        if measured is not None:
            axes[k, 0].plot(t, measured[:, k], color="#999999", linewidth=2.4, label="measured")
        axes[k, 0].plot(t, q[:, k], color=COLOURS[0], label="simulated")
        axes[k, 1].plot(t, dq[:, k], color=COLOURS[0])
        axes[k, 0].set_ylabel(f"{name} [{unit}]")
        axes[k, 1].set_ylabel(f"[{unit}/s]")
    if measured is not None:
        made.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper right", ncols=2, fontsize=7)
    for axis in axes[-1]:
        axis.set_xlabel("time [s]")
    return svg(made)
