"""modelgen simulate: a motion of the model, alone or against a log."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import typer
from numpy.typing import NDArray
from rich.console import Console
from rich.progress import Progress

from modelgen.cli.files import check_writable, write_together
from modelgen.cli.output import print_json, print_table
from modelgen.dataset import prepare, read, read_columns
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.figures import COLOURS, figure, svg
from modelgen.simulation import Plant, Reference, Replay, Trajectory, plant, replay, simulate
from modelgen.simulation.animation import animation
from modelgen.simulation.control import controller
from modelgen.simulation.values import by_joint, locks, numbers

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Request:
    """What the user asked for, as the options have it."""

    q0: str
    dq0: str
    duration: float | None
    rate: float | None
    lock: Sequence[str]
    payload: str
    out: Path | None
    log: str | None
    mapping: Path | None
    control: str
    reference: Path | None
    bandwidth: float
    method: str
    step: float | None
    window: float | None
    plot: Path | None
    animation: Path | None
    as_json: bool


def run(arm: Arm, parameters: Mapping[str, float] | None, r: Request) -> None:
    """Simulate and write. Raises InputError; what ran before a motion broke off is kept."""
    for option, path in (("--out", r.out), ("--plot", r.plot), ("--animation", r.animation)):
        if path is not None:
            check_writable(option, path)
    made = plant(arm, parameters, lock=locks(r.lock), payload=numbers("--payload", r.payload))
    if r.log is None:
        _alone(made, r)
    else:
        _against(made, r, r.log)


def _alone(p: Plant, r: Request) -> None:
    """No log: the motion, its energy, when it comes to rest."""
    if r.window is not None:
        raise InputError("--window cuts a log into windows: give --log FILE too")
    reference = None if r.reference is None else _reference(p, r.reference)
    if bool(r.control) != (reference is not None):
        raise InputError("--control and --reference belong together: found one without the other")
    duration = r.duration
    if duration is None:
        if reference is None:
            raise InputError("--duration: found none, expected seconds, or a --log or --reference")
        duration = float(reference.t[-1] - reference.t[0])
    rate = 1000.0 if r.rate is None else r.rate
    begin = np.zeros(p.n) if reference is None else reference.at(reference.t[0])[0]
    q0 = by_joint("--q0", r.q0, p.names) if r.q0 else begin
    control = None
    if reference is not None:
        control = controller(p, r.control, reference, r.bandwidth, rate)
    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("simulating", total=duration)
        found = simulate(
            p,
            q0,
            by_joint("--dq0", r.dq0, p.names),
            duration,
            rate,
            control,
            method=r.method,
            step=r.step,
            stop_at_limits=control is not None,
            progress=lambda t: bar.update(task, completed=t),
        )
    _write(p, found.t, found.q, found.dq, r, None)
    data = _facts(p, found)
    if r.as_json:
        print_json(data)
    else:
        _print(p, found, data)
    if found.ended:
        kept = f"; the {len(found.t)} samples before it are in {r.out}" if r.out else ""
        raise InputError(f"{p.arm.name}: {found.ended}{kept}")


def _against(p: Plant, r: Request, log: str) -> None:
    """The log's inputs, and how well the positions agree."""
    for option, value in (("--duration", r.duration), ("--rate", r.rate), ("--reference", r.reference)):
        if value is not None:
            raise InputError(f"{option}: the log has its own; use FILE@t0:t1 for a part of it")
    record = read(log, p.arm, r.mapping)
    prepared = prepare(record)
    start = None
    if r.q0:
        start = by_joint("--q0", r.q0, p.names), by_joint("--dq0", r.dq0, p.names)
    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("simulating", total=float(record.t[-1] - record.t[0]))
        found = replay(
            p,
            prepared,
            window=r.window,
            control=r.control,
            bandwidth=r.bandwidth,
            method=r.method,
            step=r.step,
            start=start,
            progress=lambda t: bar.update(task, completed=t),
        )
    ran = np.isfinite(found.simulated).all(axis=1)
    _write(p, found.t[ran], found.simulated[ran], found.velocities[ran], r, found.measured[ran])
    data = _fit(p, found)
    if r.as_json:
        print_json(data)
    else:
        rows = [
            [
                str(j["joint"]),
                _cell(j["f_gof_percent"], 2),
                _cell(j["mae"], 6),
                _cell(j["rmse"], 6),
                j["unit"],
            ]
            for j in data["joints"]
        ]
        print_table("", dict.fromkeys(("joint", "F_gof %", "MAE", "RMSE", "unit"), "right"), rows)
    if found.ended:
        raise InputError(f"{p.arm.name}: {found.ended}; the scores are those of the samples before it")


def _cell(value: float | None, digits: int) -> str:
    return "" if value is None else f"{value:.{digits}f}"


def _reference(p: Plant, path: Path) -> Reference:
    """t and q<n> of a table, of modelgen excite say."""
    names = ["t", *(f"q{k + 1}" for k in range(p.n))]
    columns = read_columns(str(path), names)
    t, *q = (np.asarray(columns[name], dtype=float) for name in names)
    if len(t) < 4 or not (np.diff(t) > 0).all() or not np.isfinite(np.array([t, *q])).all():
        raise InputError(f"--reference {path}: expected four finite samples at least, with t growing")
    return Reference(t, np.stack(q, axis=1))


def _facts(p: Plant, found: Trajectory) -> dict[str, Any]:
    """Where it ended, when it came to rest, what became of its energy."""
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
    from modelgen.backends import NumpyFunction  # noqa: PLC0415 - not for replays

    function = NumpyFunction(next(f for f in p.model.functions if f.name == "energy"))
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


def _fit(p: Plant, found: Replay) -> dict[str, Any]:
    def number(x: float) -> float | None:
        return float(x) if np.isfinite(x) else None

    s = found.scores
    joints = [
        {
            "joint": k + 1,
            "f_gof_percent": number(s.f_gof[k]),
            "mae": number(s.mae[k]),
            "rmse": number(s.rmse[k]),
            "unit": _units(p)[k],
        }
        for k in range(p.n)
    ]
    return {"arm": p.arm.name, "windows": found.windows, "joints": joints, "ended": found.ended or None}


def _units(p: Plant) -> list[str]:
    return ["m" if p.arm.joints[i].type == "prismatic" else "rad" for i in p.arm.coordinates]


def _print(p: Plant, found: Trajectory, data: dict[str, Any]) -> None:
    rows = [
        [name, f"{q0:.6g}", f"{q1:.6g}", f"{low:.6g}", f"{high:.6g}", unit]
        for name, q0, q1, low, high, unit in zip(
            p.names, found.q[0], found.q[-1], found.q.min(axis=0), found.q.max(axis=0), _units(p), strict=True
        )
    ]
    headings = {"joint": "left"} | dict.fromkeys(("q begin", "q end", "lowest", "highest"), "right")
    print_table("", headings | {"unit": "left"}, rows)
    rest = data["at_rest_from"]
    typer.echo("moves until the end" if rest is None else f"at rest from {rest:.6g} s on")
    change = data["energy"]["end"] - data["energy"]["begin"]
    typer.echo(f"energy {data['energy']['begin']:.6g} J at the beginning, {change:+.6g} J since")


def _write(p: Plant, t: Array, q: Array, dq: Array, r: Request, measured: Array | None) -> None:
    """The table, the picture, the animation."""
    if r.out is not None:
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(["t", *(f"q{k + 1}" for k in range(p.n)), *(f"dq{k + 1}" for k in range(p.n))])
        writer.writerows([f"{x:.12g}" for x in row] for row in np.column_stack([t, q, dq]))
        write_together("--out", r.out.parent, {r.out.name: text.getvalue()})
    if r.plot is not None:
        write_together("--plot", r.plot.parent, {r.plot.name: _picture(p, t, q, dq, measured)})
    if r.animation is not None:
        write_together("--animation", r.animation.parent, {r.animation.name: animation(p, t, q)})


def _picture(p: Plant, t: Array, q: Array, dq: Array, measured: Array | None) -> str:
    """Position and speed of every joint over time."""
    made, axes = figure(p.n, 2, (9.0, 1.7 * p.n + 0.3))
    for k, (name, unit) in enumerate(zip(p.names, _units(p), strict=True)):
        if measured is not None:
            axes[k, 0].plot(t, measured[:, k], color="#999999", label="measured")
        axes[k, 0].plot(t, q[:, k], color=COLOURS[0], label="simulated")
        axes[k, 1].plot(t, dq[:, k], color=COLOURS[0])
        axes[k, 0].set_ylabel(f"{name} [{unit}]")
        axes[k, 1].set_ylabel(f"[{unit}/s]")
    if measured is not None:
        axes[0, 0].legend(loc="upper right", fontsize=7)
    for axis in axes[-1]:
        axis.set_xlabel("time [s]")
    return svg(made)
