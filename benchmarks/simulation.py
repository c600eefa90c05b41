"""Sixty seconds of ariane6 in steps of 1 ms: python benchmarks/simulation.py.

The compiled path of `modelgen simulate` (classical Runge-Kutta, dry friction as a set, lever drives) beside
MuJoCo's mj_step on the same links without gravity, constant armature, damping and frictionloss in place of
the levers, both on one core in one run. Needs mujoco.
"""

from __future__ import annotations

import sys
import time
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))

from simulation_support import middle, with_bodies
from witness.bodies import random_bodies
from witness.geometry import moving
from witness.levers import Drive
from witness.multi_body import MultiBody

from modelgen.description import load
from modelgen.effects import known_effects
from modelgen.resources import shipped_arms
from modelgen.simulation import simulate

SECONDS, STEP, RUNS = 60.0, 1e-3, 5


def main() -> None:
    """Print times and ratios."""
    arm = load(shipped_arms(), known_effects())["ariane6"]
    # Without gravity, so that currents alone keep it within its strokes for a minute.
    arm = replace(arm, gravity=(0.0, 0.0, 0.0))
    rng = np.random.default_rng(3)
    bodies = random_bodies(arm, rng)
    drives = [Drive(arm, i) for i in moving(arm)]
    n = len(drives)
    probe = with_bodies(arm, bodies, {"IA": np.ones(n), "FV": np.ones(n), "FC": np.ones(n)})
    q0 = middle(probe)
    k1 = np.array([d.k1(q) for d, q in zip(drives, q0, strict=True)])
    armature, damping, dry = 3.0, 30.0, 4.0  # kg m2, N m s, N m at the joints
    made = with_bodies(
        arm, bodies, {"IA": armature / k1**2, "FV": damping / k1**2, "FC": dry / np.abs(k1) * np.ones(n)}
    )
    gain = k1 * np.array([d.constant for d in drives])
    t = np.arange(round(SECONDS / STEP) + 1) * STEP
    effort = 14.0 * np.cos(2 * np.pi * t[:, None] * np.linspace(0.3, 0.9, n))
    peer = MultiBody(
        arm,
        bodies,
        [{"armature": armature, "damping": damping, "frictionloss": dry} for _ in range(n)],
    )
    peer.model.opt.timestep = STEP
    simulate(made, q0, 0.0, 0.1, 1 / STEP, effort[:101] / gain, method="fixed", step=STEP)  # compiles
    ours: list[float] = []
    euler: list[float] = []
    rk4: list[float] = []
    for _ in range(RUNS):
        begin = time.perf_counter()
        found = simulate(made, q0, 0.0, SECONDS, 1 / STEP, effort / gain, method="fixed", step=STEP)
        ours.append(time.perf_counter() - begin)
        if found.ended:
            raise SystemExit(found.ended)
        for times, integrator in (
            (euler, mujoco.mjtIntegrator.mjINT_EULER),
            (rk4, mujoco.mjtIntegrator.mjINT_RK4),
        ):
            peer.model.opt.integrator = integrator
            mujoco.mj_resetData(peer.model, peer.data)
            peer.data.qpos[peer.places] = q0
            begin = time.perf_counter()
            for k in range(len(t) - 1):
                peer.data.qfrc_applied[peer.places] = effort[k]
                mujoco.mj_step(peer.model, peer.data)
            times.append(time.perf_counter() - begin)
    rests = (found.dq == 0).mean(axis=0)
    print(f"joints travel {np.abs(np.diff(found.q, axis=0)).sum(axis=0).round(1).tolist()} rad,", end=" ")
    print(f"stick {(100 * rests).round().astype(int).tolist()} % of the time")
    print(f"modelgen, {SECONDS:g} s in steps of {1e3 * STEP:g} ms: {spread(ours)} s")
    for name, times in (("Euler", euler), ("RK4", rk4)):
        ratios = [b / a for a, b in zip(ours, times, strict=True)]
        print(f"MuJoCo mj_step, {name}: {spread(times)} s, {spread(ratios)} times as long")


def spread(values: list[float]) -> str:
    """Median and range."""
    return f"{np.median(values):.2f} ({min(values):.2f} to {max(values):.2f})"


if __name__ == "__main__":
    main()
