"""MPC of the levered arm in closed loop, with every formulation and solver.

    python examples/mpc/mpc_run.py            some minutes: tables on stdout, plots beside this file
    python examples/mpc/mpc_run.py --quick    a few plans of each kind, no plots

docs/mpc.md explains it and has the figures.
"""

from __future__ import annotations

import os

# One thread: the times are those of one core. Read when the solvers' libraries are loaded.
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[variable] = "1"

# ruff: noqa: E402 - see above
import argparse
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from mpc_arm import ControlledArm, controlled, described, perturbed
from mpc_horizon import Horizon
from mpc_loop import Run, closed_loop
from mpc_plant import Plant, compiled
from mpc_timing import BENCH_EFFORT, Progress, Timing, benchmark, comparison, in_c
from rich.console import Console
from rich.progress import Progress as Bar
from rich.table import Table

from modelgen.errors import InputError

HERE = Path(__file__).resolve().parent
BUILD = HERE / "build"
SHIPPED = HERE.parents[1] / "arms.yaml"
SEED = 1  # of the wrong parameters
DURATION = 24.0  # s, of the runs that are plotted
COMPARED = 5.0  # s, of the runs whose solve times are compared


def main() -> None:
    """Run, print, plot."""
    parser = argparse.ArgumentParser(description="MPC of the levered arm in closed loop.")
    parser.add_argument("--quick", action="store_true", help="a few plans of each kind, no plots")
    quick = parser.parse_args().quick
    jit = BUILD / "jit"
    jit.mkdir(parents=True, exist_ok=True)
    try:
        arm = controlled(described(HERE / "arms.yaml", "ariane4_mpc"), BUILD / "generated")
        bench = controlled(described(SHIPPED, "yaw3pitch"), BUILD / "generated", BENCH_EFFORT)
        made = plants(arm)
        compared = 0.25 if quick else COMPARED
        runs = tracking(arm, made, jit, 0.5 if quick else DURATION)
        with shown("comparing solvers") as progress:
            timings = comparison(arm, made["wrong"], jit, compared, progress)
        generated = (BUILD / "generated" / arm.name, SHIPPED.parent / "generated" / "ariane4")
        timings.append(in_c(arm, generated, perturbed(arm, SEED), BUILD / "c", compared))
        with shown("benchmark") as progress:
            cold = benchmark(bench, jit, 3 if quick else 51, progress)
    except (InputError, RuntimeError, ValueError) as error:
        sys.exit(f"examples/mpc: {error}")
    out = Console(width=110)
    table(out, "ariane4 in closed loop, 20 intervals of 50 ms, warm start", timings)
    table(out, "yaw3pitch, one plan, 20 intervals of 50 ms, cold start", cold)
    beside(out, timings)
    report(out, arm, runs)
    if not quick:
        from mpc_plots import draw  # noqa: PLC0415 - needs matplotlib, nothing else does

        draw(HERE, arm, runs, timings)


def plants(arm: ControlledArm) -> dict[str, Plant]:
    """Three plants in compiled C.

    "smoothed": the controller's own model. "exact": its parameters, but dry friction with a sign.
    "wrong": dry friction with a sign, and parameters that are wrong by up to 10 %.
    """
    signed = compiled(SHIPPED.parent / "generated", "ariane4", BUILD)
    smoothed = compiled(BUILD / "generated", arm.name, BUILD)
    return {
        "smoothed": Plant(smoothed, arm.name, arm.parameters, arm.n),
        "exact": Plant(signed, "ariane4", arm.parameters, arm.n),
        "wrong": Plant(signed, "ariane4", perturbed(arm, SEED), arm.n),
    }


def tracking(arm: ControlledArm, made: dict[str, Plant], jit: Path, duration: float) -> dict[str, Run]:
    """Closed loops with inverse dynamics, fatrop and JIT, one for each plant."""
    horizon = Horizon(arm, "inverse", "fatrop", compiled_in=jit)
    runs = {}
    for name, plant in made.items():
        with shown(f"tracking, plant: {name}") as progress:
            runs[name] = closed_loop(horizon, plant, duration, progress)
    return runs


@contextmanager
def shown(text: str) -> Iterator[Progress]:
    """A bar on a terminal, a line elsewhere; on stderr."""
    console = Console(stderr=True)
    if not console.is_terminal:
        console.print(text)
    with Bar(console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task(text)
        yield lambda done, total: bar.update(task, completed=done, total=total)


def table(out: Console, title: str, timings: list[Timing]) -> None:
    """Solve times as ratios to the fastest, with their spread."""
    unit = min(float(np.median(t.cpu)) for t in timings)
    made = Table(title=title, title_justify="left", box=None)
    made.add_column("")
    for heading in ("time / fastest", "10-90 %", "median ms", "iterations", "failed", "build s", "error deg"):
        made.add_column(heading, justify="right")
    for t in sorted(timings, key=lambda t: float(np.median(t.cpu))):
        low, middle, high = np.quantile(t.cpu, [0.1, 0.5, 0.9])
        made.add_row(
            t.name,
            f"{middle / unit:.1f}",
            f"{low / unit:.1f}-{high / unit:.1f}",
            f"{1e3 * middle:.1f}",
            f"{np.median(t.iterations):.0f}",
            f"{t.failures} of {t.cpu.size}",
            f"{t.build:.1f}",
            "" if np.isnan(t.rms) else f"{t.rms:.2f}",
        )
    out.print(made, "")


def beside(out: Console, timings: list[Timing]) -> None:
    """How far the arm is driven elsewhere in C than with CasADi and fatrop: the formulation is the same."""
    driven = {t.name: t.run for t in timings}
    ours, theirs = driven[timings[-1].name], driven["forward dynamics, fatrop, JIT"]
    assert ours is not None
    assert theirs is not None
    angles = np.rad2deg(abs(ours.states - theirs.states)[:, : ours.states.shape[1] // 2].max())
    currents = abs(ours.inputs - theirs.inputs).max()
    out.print(f"in C and with fatrop the angles differ by {angles:.5f} deg, currents by {currents:.4f} A", "")


def report(out: Console, arm: ControlledArm, runs: dict[str, Run]) -> None:
    """Tracking errors and how far the limits were used."""
    assert arm.drives is not None
    span = arm.drives.high - arm.drives.low
    made = Table(title="tracking error by plant, joint after joint", title_justify="left", box=None)
    for heading in ("plant", "rms deg", "largest current / limit", "stroke used %"):
        made.add_column(heading)
    for name, run in runs.items():
        used = 100 * (np.array([run.motor.min(0), run.motor.max(0)]) - arm.drives.low) / span
        made.add_row(
            name,
            " ".join(f"{np.rad2deg(e):.2f}" for e in np.sqrt((run.error**2).mean(0))),
            " ".join(f"{v:.3f}" for v in abs(run.inputs).max(0) / arm.effort),
            " ".join(f"{a:.1f}-{b:.1f}" for a, b in used.T),
        )
    out.print(made)


if __name__ == "__main__":
    main()
