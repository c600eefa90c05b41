"""modelgen simulate --log: measured runs and what the model makes of their inputs."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from rich.console import Console
from rich.progress import Progress, TaskID

from modelgen.cli.output import print_json, print_table
from modelgen.cli.simulating import Request, units, write
from modelgen.dataset import prepare, read
from modelgen.errors import InputError
from modelgen.simulation import Plant, Replay, Scores, replay, scores
from modelgen.simulation.metrics import repeated
from modelgen.simulation.values import by_joint


def against(p: Plant, r: Request) -> None:
    """Every log's inputs, and how well the positions agree; of several logs, their mean and scatter too."""
    for option, value in (
        ("--duration", r.duration),
        ("--rate", r.rate),
        ("--reference", r.reference),
        ("--input", r.inputs),
    ):
        if value is not None:
            raise InputError(f"{option}: the log has its own; use FILE@t0:t1 for a part of it")
    start = None
    if r.q0:
        start = by_joint("--q0", r.q0, p.names), by_joint("--dq0", r.dq0, p.names)
    records = [prepare(read(log, p.arm, r.mapping)) for log in r.logs]
    total = sum(float(x.time[-1] - x.time[0]) for x in records)
    console = Console(stderr=True)
    found: list[Replay] = []
    with Progress(console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("simulating", total=total)
        before = 0.0
        for record in records:
            found.append(
                replay(
                    p,
                    record,
                    window=r.window,
                    control=r.control,
                    bandwidth=r.bandwidth,
                    method=r.method,
                    step=r.step,
                    start=start,
                    progress=partial(_advance, bar, task, before),
                )
            )
            before += float(record.time[-1] - record.time[0])
    first = found[0]
    ran = np.isfinite(first.simulated).all(axis=1)
    write(p, first.t[ran], first.simulated[ran], first.velocities[ran], r, first.measured[ran])
    data = _data(p, r, found)
    if r.as_json:
        print_json(data)
    else:
        _print(data, len(found) > 1)
    for log, one in zip(r.logs, found, strict=True):
        if one.ended:
            raise InputError(f"{log}: {one.ended}; the scores are those of the samples before it")


def _advance(bar: Progress, task: TaskID, before: float, t: float) -> None:
    bar.update(task, completed=before + t)


def _data(p: Plant, r: Request, found: list[Replay]) -> dict[str, Any]:
    """Scores of the only run, or of the mean of all with each run's own beside it."""
    runs = [
        {
            "log": log,
            "windows": one.windows,
            "joints": _joints(p, one.scores),
            "ended": one.ended or None,
        }
        for log, one in zip(r.logs, found, strict=True)
    ]
    data: dict[str, Any] = {"arm": p.arm.name, "windows": found[0].windows, "ended": found[0].ended or None}
    if len(found) == 1:
        return data | {"joints": runs[0]["joints"]}
    steps = [float(one.t[1] - one.t[0]) for one in found]
    if np.ptp(steps) > 1e-3 * steps[0]:
        raise InputError("--log: runs of different sampling periods cannot be averaged; resample them alike")
    measured, scatter = repeated([one.measured for one in found])
    simulated, _ = repeated([one.simulated for one in found])
    ran = np.isfinite(simulated).all(axis=1)
    joints = _joints(p, scores(measured[ran], simulated[ran]))
    for joint, x in zip(joints, scatter, strict=True):
        joint["scatter"] = float(x)
    return data | {"joints": joints, "runs": runs}


def _joints(p: Plant, s: Scores) -> list[dict[str, Any]]:
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
        for k, unit in enumerate(units(p))
    ]


def _print(data: dict[str, Any], several: bool) -> None:
    columns = {"run": "left"} if several else {}
    columns |= dict.fromkeys(("joint", "F_gof %", "MAE", "RMSE", "unit"), "right")
    parts = [(x["log"], x["joints"]) for x in data["runs"]] if several else []
    rows = []
    for name, joints in [*parts, ("mean of all" if several else "", data["joints"])]:
        for j in joints:
            row = [str(j["joint"]), _cell(j["f_gof_percent"], 2), _cell(j["mae"], 6), _cell(j["rmse"], 6)]
            rows.append([*([name] if several else []), *row, j["unit"]])
    print_table("", columns, rows)
    if several:
        said = ", ".join(f"{j['scatter']:.3g} {j['unit']}" for j in data["joints"])
        print_table("", {"scatter of the runs, which no model can explain": "left"}, [[said]])


def _cell(value: float | None, digits: int) -> str:
    return "" if value is None else f"{value:.{digits}f}"
