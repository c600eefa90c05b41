"""Solve times of every formulation and solver, in closed loop and from a cold start.

The times are CPU times of the process, which runs one thread: another process on the machine moves them
less than it moves the time on the wall.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from mpc_arm import ControlledArm
from mpc_c import built, closed_loop_in_c, daqp
from mpc_horizon import FORMULATIONS, SOLVERS, Horizon
from mpc_loop import Run, closed_loop
from mpc_plant import Plant

BENCH_EFFORT = np.array([300.0, 300.0, 150.0, 40.0])  # N m, of yaw3pitch; assumed
BENCH_FLAGS = ("-O3", "-march=native")


@dataclass(frozen=True)
class Timing:
    """CPU times of one kind of solver: per plan [s], and wall time to build it [s]."""

    formulation: str
    solver: str
    jit: bool
    cpu: np.ndarray
    iterations: np.ndarray
    build: float
    failures: int  # plans that did not converge
    run: Run | None = None  # what was driven; nothing in a benchmark without a plant

    @property
    def name(self) -> str:
        """For tables and axes."""
        return f"{self.formulation} dynamics, {self.solver}{', JIT' if self.jit else ''}"

    @property
    def rms(self) -> float:
        """Root mean square of the tracking error [deg], over joints and time; nan without a run."""
        return np.nan if self.run is None else float(np.rad2deg(np.sqrt(np.mean(self.run.error**2))))


Progress = Callable[[int, int], None]


def comparison(
    arm: ControlledArm, plant: Plant, jit: Path, duration: float, progress: Progress
) -> list[Timing]:
    """The same closed loop with every formulation and solver, compiled in the folder `jit` or not."""
    kinds = [(f, s, j) for f in FORMULATIONS for s in SOLVERS for j in (True, False)]
    timings = []
    for done, (formulation, solver, compile_it) in enumerate(kinds):
        progress(done, len(kinds))
        horizon = Horizon(arm, formulation, solver, compiled_in=jit if compile_it else None)
        run = closed_loop(horizon, plant, duration)
        timings.append(
            Timing(
                formulation,
                solver,
                compile_it,
                run.cpu,
                run.iterations,
                horizon.build_time,
                run.failures,
                run,
            )
        )
    return timings


def in_c(
    arm: ControlledArm, generated: tuple[Path, Path], parameters: np.ndarray, build: Path, duration: float
) -> Timing:
    """The same closed loop from C alone; see mpc_c.built.

    parameters: base parameters of the plant. Raises RuntimeError where DAQP or a compiler is missing.
    """
    sources = daqp(build)
    begin = time.perf_counter()
    program = built(arm, generated, sources, build)
    spent = time.perf_counter() - begin
    run = closed_loop_in_c(program, arm, parameters, duration)
    return Timing("forward", "C with DAQP", False, run.cpu, run.iterations, spent, run.failures, run)


def benchmark(arm: ControlledArm, jit: Path, repetitions: int, progress: Progress) -> list[Timing]:
    """One plan of yaw3pitch from rest to a pose up to 46 degrees away, from a guess that stands still.

    Raises RuntimeError where a solver does not converge.
    """
    start = np.array([0.0, 0.6, -0.9, 0.4, 0, 0, 0, 0])
    goal = np.tile([0.8, 0.9, -1.4, -0.2, 0, 0, 0, 0], (21, 1))
    kinds = [("inverse", s, j) for s in SOLVERS for j in (True, False)] + [("forward", "ipopt", True)]
    timings = []
    for done, (formulation, solver, compile_it) in enumerate(kinds):
        progress(done, len(kinds))
        folder = jit if compile_it else None
        horizon = Horizon(arm, formulation, solver, compiled_in=folder, flags=BENCH_FLAGS, substeps=1)
        plans = [horizon.solve(start, goal) for _ in range(repetitions)]
        if not plans[0].success:
            raise RuntimeError(f"{arm.name}: {solver} did not converge with {formulation} dynamics")
        cpu, iterations = np.array([p.cpu for p in plans]), np.array([p.iterations for p in plans])
        timings.append(Timing(formulation, solver, compile_it, cpu, iterations, horizon.build_time, 0))
    return timings
