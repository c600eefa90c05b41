"""An excitation trajectory as text: tables for the controller, JSON."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from modelgen.dataset import drives_of
from modelgen.excitation.determined import determined
from modelgen.excitation.run import Excitation
from modelgen.numeric import Array

WORST = 3  # parameters that are named
_TRAJECTORY = ("q", "dq", "ddq", "qm", "dqm")


def table(columns: dict[str, Array]) -> str:
    """CSV with a heading, nine digits."""
    rows = np.column_stack(list(columns.values()))
    lines = [",".join(columns)]
    lines += [",".join(f"{x + 0.0:.9g}" for x in row) for row in rows]
    return "\n".join(lines) + "\n"


def trajectory(e: Excitation) -> str:
    """CSV: t [s], q, dq, ddq of every joint [rad, m], qm, dqm [motor unit]; the period's end included.

    The last row repeats the first one a period later, so that rows 1 to N can be run in a loop.
    """
    n = len(e.problem.middle)
    names = [(name, k) for name in _TRAJECTORY for k in range(n)]
    return table({"t": _closed_time(e)} | {f"{x}{k + 1}": _closed(e.signals[x][:, k]) for x, k in names})


def set_points(e: Excitation) -> str:
    """CSV: t [s] and qm of every joint [motor unit], what a position controller is given."""
    n = len(e.problem.middle)
    return table({"t": _closed_time(e)} | {f"qm{k + 1}": _closed(e.signals["qm"][:, k]) for k in range(n)})


def _closed(x: Array) -> Array:
    return np.append(x, x[0])


def _closed_time(e: Excitation) -> Array:
    return np.append(e.t, e.problem.settings.period)


def data(e: Excitation) -> dict[str, Any]:
    """The trajectory's figures and its coefficients as plain data."""
    p, s = e.problem, e.problem.settings
    full = p.basis.coefficients(e.z) * p.amplitude[:, None]
    full[:, 0] += p.middle
    h = s.harmonics
    joints = []
    for k, i in enumerate(e.arm.coordinates):
        unit = drives_of(e.arm)[k].unit
        if s.coordinates == "joint":
            unit = e.arm.joints[i].unit
        joints.append(
            {
                "joint": k + 1,
                "name": e.arm.joints[i].name,
                "unit": unit,
                "mean": _number(full[k, 0]),
                "sin": [_number(x) for x in full[k, 1 : h + 1]],
                "cos": [_number(x) for x in full[k, h + 1 :]],
            }
        )
    reached = sorted(x for x in e.values if np.isfinite(x))
    return {
        "arm": e.arm.name,
        "period": s.period,
        "harmonics": h,
        "rate": s.rate,
        "coordinates": s.coordinates,
        "criterion": s.criterion,
        "rest": s.rest,
        "starts": s.starts,
        "seed": s.seed,
        "condition_number": _number(e.condition),
        "condition_number_unscaled": _number(e.raw),
        "condition_numbers_of_starts": [_number(x) for x in reached],
        "base_parameters": len(p.names),
        "samples": len(e.t),
        "worst_determined": [
            {
                "parameter": d.name,
                "joint": d.joint + 1,
                "effort": _number(d.size),
                "percent_of_effort": None if d.share is None else _number(d.share),
            }
            for d in determined(e)[:WORST]
        ],
        "limits_used": {name: round(x, 4) for name, x in e.usage.items()},
        "series": joints,
        "remarks": [*e.arm.notes, *p.remarks],
    }


def _number(x: float) -> float:
    """Nine digits: what the text files carry."""
    return float(f"{x:.9g}")


def files(e: Excitation, stem: str) -> dict[str, str]:
    """Name to text of everything that is written beside each other."""
    return {
        f"{stem}.csv": trajectory(e),
        f"{stem}_set_points.csv": set_points(e),
        f"{stem}.json": json.dumps(data(e), indent=2, allow_nan=False) + "\n",
    }
