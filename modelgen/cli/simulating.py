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
from rich.console import Console
from rich.progress import Progress

from modelgen.cli.files import check_writable, write_together
from modelgen.cli.output import print_json, print_table
from modelgen.dataset import read_columns
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.figures import COLOURS, figure, svg
from modelgen.numeric import Array
from modelgen.report.animation import animation
from modelgen.simulation import Plant, Reference, Trajectory, plant, simulate
from modelgen.simulation.control import Control, controller
from modelgen.simulation.simulate import check_length
from modelgen.simulation.values import by_joint, locks, numbers


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
    logs: Sequence[str]
    mapping: Path | None
    control: str
    reference: Path | None
    inputs: Path | None
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
    if r.logs:
        from modelgen.cli.replaying import against  # noqa: PLC0415 - it imports this module

        against(made, r)
    else:
        _alone(made, r)


def _alone(p: Plant, r: Request) -> None:
    """No log: the motion, its energy, when it comes to rest."""
    if r.window is not None:
        raise InputError("--window cuts a log into windows: give --log FILE too")
    reference = None if r.reference is None else reference_of(p.n, r.reference)
    if bool(r.control) != (reference is not None):
        raise InputError("--control and --reference belong together: found one without the other")
    given = None if r.inputs is None else _inputs(p, r.inputs)
    if given is not None and reference is not None:
        raise InputError("--input and --control: the inputs are given or controlled, not both")
    duration = r.duration
    if duration is None:
        axis = reference.t if reference is not None else None if given is None else given[0]
        if axis is None:
            raise InputError("--duration: found none, expected seconds, or --log, --input or --reference")
        duration = float(axis[-1] - axis[0])
    rate = 1000.0 if r.rate is None else r.rate
    begin = _somewhere(p) if reference is None else reference.at(reference.t[0])[0]
    q0 = by_joint("--q0", r.q0, p.names) if r.q0 else begin
    control: Control | Array | None = None
    check_length(duration, rate)
    if given is not None:
        at = given[0][0] + np.arange(round(duration * rate) + 1) / rate
        control = given[1][np.searchsorted(given[0], at + 1e-9 / rate, side="right") - 1]
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
            stop_at_limits=reference is not None,
            progress=lambda t: bar.update(task, completed=t),
        )
    moved = control is not None
    write(p, found.t, found.q, found.dq, r, None, found.input if moved else None)
    data = _facts(p, found)
    if r.as_json:
        print_json(data)
    else:
        _print(p, found, data)
    if found.ended:
        kept = f"; the {len(found.t)} samples before it are in {r.out}" if r.out else ""
        raise InputError(f"{p.arm.name}: {found.ended}{kept}")


def _somewhere(p: Plant) -> Array:
    """0 where the stroke has it, else the stroke's middle."""
    low, high = p.strokes
    inside = (low <= 0) & (high >= 0)
    with np.errstate(invalid="ignore"):
        return np.where(inside, 0.0, (low + high) / 2)


def reference_of(n: int, path: Path) -> Reference:
    """t and q<n> of a table, of modelgen excite say, for n coordinates."""
    names = ["t", *(f"q{k + 1}" for k in range(n))]
    return Reference(*_table("--reference", path, names))


def _inputs(p: Plant, path: Path) -> tuple[Array, Array]:
    """t (S,) and inputs (S, n): i<n> [A] of driven joints, tau<n> [N m, N] of the others."""
    return _table("--input", path, ["t", *_input_names(p)])


def _input_names(p: Plant) -> list[str]:
    """The inputs' columns in a log."""
    drives = [p.arm.joints[i].drive for i in p.arm.coordinates]
    return [f"{'i' if d.driven else 'tau'}{k + 1}" for k, d in enumerate(drives)]


def _table(option: str, path: Path, names: list[str]) -> tuple[Array, Array]:
    columns = read_columns(str(path), names)
    t, *rest = (np.asarray(columns[name], dtype=float) for name in names)
    if len(t) < 4 or not (np.diff(t) > 0).all() or not np.isfinite(np.array([t, *rest])).all():
        raise InputError(f"{option} {path}: expected four finite samples at least, with t growing")
    return t, np.stack(rest, axis=1)


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


def units(p: Plant) -> list[str]:
    """rad or m, joint by joint."""
    return ["m" if p.arm.joints[i].type == "prismatic" else "rad" for i in p.arm.coordinates]


def _print(p: Plant, found: Trajectory, data: dict[str, Any]) -> None:
    rows = [
        [name, f"{q0:.6g}", f"{q1:.6g}", f"{low:.6g}", f"{high:.6g}", unit]
        for name, q0, q1, low, high, unit in zip(
            p.names, found.q[0], found.q[-1], found.q.min(axis=0), found.q.max(axis=0), units(p), strict=True
        )
    ]
    headings = {"joint": "left"} | dict.fromkeys(("q begin", "q end", "lowest", "highest"), "right")
    print_table("", headings | {"unit": "left"}, rows)
    rest = data["at_rest_from"]
    typer.echo("moves until the end" if rest is None else f"at rest from {rest:.6g} s on")
    change = data["energy"]["end"] - data["energy"]["begin"]
    typer.echo(f"energy {data['energy']['begin']:.6g} J at the beginning, {change:+.6g} J since")


def write(
    p: Plant,
    t: Array,
    q: Array,
    dq: Array,
    r: Request,
    measured: Array | None,
    inputs: Array | None = None,
) -> None:
    """The table, with the inputs (S, n) where there are any, the picture, the animation."""
    if r.out is not None:
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        names = ["t", *(f"q{k + 1}" for k in range(p.n)), *(f"dq{k + 1}" for k in range(p.n))]
        columns = [t, q, dq] if inputs is None else [t, q, dq, inputs]
        writer.writerow(names if inputs is None else [*names, *_input_names(p)])
        writer.writerows([f"{x:.12g}" for x in row] for row in np.column_stack(columns))
        write_together("--out", r.out.parent, {r.out.name: text.getvalue()})
    if r.plot is not None:
        write_together("--plot", r.plot.parent, {r.plot.name: _picture(p, t, q, dq, measured)})
    if r.animation is not None:
        write_together("--animation", r.animation.parent, {r.animation.name: animation(p, t, q)})


def _picture(p: Plant, t: Array, q: Array, dq: Array, measured: Array | None) -> str:
    """Position and speed of every joint over time."""
    made, axes = figure(p.n, 2, (9.0, 1.7 * p.n + 0.3))
    for k, (name, unit) in enumerate(zip(p.names, units(p), strict=True)):
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
