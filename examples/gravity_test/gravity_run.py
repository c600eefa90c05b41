"""The simulations of the gravity test, what the published scores say, a measurement with a hidden cause.

    python examples/gravity_test/gravity_run.py     half a minute: tables on stdout, pictures beside this file

README.md explains it and has the figures.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
from gravity_pictures import link_1, link_2
from numpy.typing import NDArray
from plant import DURATIONS, HIDDEN, RATE, measured, write
from rich.console import Console
from rich.progress import Progress

from modelgen.description import load
from modelgen.effects import known_effects
from modelgen.simulation import Scores, Trajectory, plant, scores, simulate
from modelgen.simulation.metrics import repeated

Array = NDArray[np.float64]
HERE = Path(__file__).resolve().parent
ARMS = HERE.parents[1] / "arms.yaml"
BUILD = HERE / "build"
NAMES = ("gravity_link1", "gravity_link1_loaded", "gravity_link2")
# Tables 3 and 4: F_gof [%] and MAE [deg] of 20, 30 and 40 degrees.
PUBLISHED = {
    "link 1": {20: (72.79, 1.0928), 30: (81.28, 1.0049), 40: (77.76, 1.7174)},
    "link 2": {20: (52.20, 1.2399), 30: (54.74, 1.5006), 40: (71.07, 1.2571)},
}


def simulations() -> dict[tuple[str, int], Trajectory]:
    """Every arm from every angle, for as long as it was measured."""
    arms = load(ARMS, known_effects())
    made = {name: plant(arms[name]) for name in NAMES}
    return {
        (name, degrees): simulate(made[name], np.radians(degrees), 0.0, duration, RATE)
        for name in NAMES
        for degrees, duration in DURATIONS.items()
    }


def settled(found: Trajectory) -> float | None:
    """When the arm has come to rest [s]; None where it still moves at the end."""
    moving = np.flatnonzero(found.dq[:, 0])
    return None if moving[-1] + 1 == len(found.t) else float(found.t[moving[-1] + 1])


def settling_times() -> dict[tuple[str, int], float]:
    """Likewise, however long it takes."""
    arms = load(ARMS, known_effects())
    result = {}
    for name in NAMES:
        made = plant(arms[name])
        for degrees in DURATIONS:
            at = settled(simulate(made, np.radians(degrees), 0.0, 40.0, 1000.0))
            assert at is not None, (name, degrees)
            result[name, degrees] = at
    return result


def implied(link: str, name: str, found: dict[tuple[str, int], Trajectory]) -> list[list[float]]:
    """By angle: simulated spread, error that the published F_gof makes of it [deg], MAE over that error.

    The spread of the measurement is not published; that of the simulation replaces it.
    """
    rows = []
    for degrees, (f_gof, mae) in PUBLISHED[link].items():
        spread = float(np.degrees(found[name, degrees].q[:, 0].std()))
        rms = (1 - f_gof / 100) * spread
        rows.append([degrees, spread, rms, mae / rms])
    return rows


def on_measurements(
    found: dict[tuple[str, int], Trajectory], seed: int = 0
) -> dict[int, tuple[Array, Array, Scores, float]]:
    """By angle: runs (R, S) and their mean (S,) [rad], the scores of link 2's simulation on the mean, the
    scatter of the runs [rad]."""
    result = {}
    for degrees in DURATIONS:
        _, runs = measured(HIDDEN, degrees, seed)
        mean, scatter = repeated([run[:, None] for run in runs])
        fit = scores(mean, found["gravity_link2", degrees].q)
        result[degrees] = (runs, mean[:, 0], fit, float(scatter[0]))
    return result


def modelgen(*arguments: str) -> str:
    """Run the command line; its own messages are shown where it fails."""
    call = [sys.executable, "-m", "modelgen", *arguments]
    done = subprocess.run(call, cwd=HERE.parents[1], capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"{' '.join(call)}\n{done.stderr}")
    return done.stdout


def diagnosed() -> dict[str, Any]:
    """diagnosis.json of the logs: two runs from each angle to learn from, one to judge by."""
    write(BUILD)
    train = [f"--train={BUILD / f'link2_{degrees}_{run}.csv'}" for run in (1, 2) for degrees in DURATIONS]
    test = f"--test={BUILD / 'link2_30_10.csv'}"
    modelgen("diagnose", str(ARMS), "--arm", "gravity_link2", *train, test, "--out", str(BUILD / "diagnosis"))
    found: dict[str, Any] = json.loads((BUILD / "diagnosis/diagnosis.json").read_text(encoding="utf-8"))
    return found


def main() -> None:
    """Run, print, draw."""
    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("six simulations and three", total=4)
        found = simulations()
        bar.update(task, advance=1, description="settling times")
        times = settling_times()
        bar.update(task, advance=1, description="thirty measurements")
        held = on_measurements(found)
        bar.update(task, advance=1, description="diagnosis")
        cause = diagnosed()
    print("at rest after [s]             20 deg  30 deg  40 deg   (measured for 16.315, 23.045, 26.995 s)")
    for name in NAMES:
        print(f"  {name:26}", *(f"{times[name, d]:7.2f}" for d in DURATIONS))
    print("\npublished scores:          angle  simulated spread  error by F_gof  MAE  MAE / error")
    for link, name in (("link 1", NAMES[1]), ("link 1", NAMES[0]), ("link 2", NAMES[2])):
        for degrees, spread, rms, ratio in implied(link, name, found):
            mae = PUBLISHED[link][int(degrees)][1]
            print(f"  {link}: {name:21} {degrees:3.0f} {spread:10.2f} {rms:16.2f} {mae:12.2f} {ratio:7.2f}")
    print("\nsimulation of link 2 on ten simulated measurements each, and Table 4:")
    for degrees, (_, _, fit, scatter) in held.items():
        f_gof, mae = PUBLISHED["link 2"][degrees]
        off, rmse, spread = np.degrees([fit.mae[0], fit.rmse[0], scatter])
        print(
            f"  {degrees} deg: F_gof {fit.f_gof[0]:5.1f} % ({f_gof:.1f}), MAE {off:.2f} deg ({mae:.2f}), "
            f"RMSE {rmse:.2f} deg, scatter {spread:.3f} deg"
        )
    print(f"\ndiagnosis: {cause['verdict']}")
    for c in cause["causes"]:
        values = ", ".join(f"{k} {v['value']:.3f} +- {v['std']:.3f}" for k, v in c["parameters"].items())
        print(f"  {c['effect']} at joint {c['joint']}: {values}")
    print(f"  error on the test record: {cause['error']['gain_percent'][0]:.1f} % less")
    drawn = {
        "link1.svg": link_1(found, times),
        "link2.svg": link_2(found, held, times),
    }
    for name, text in drawn.items():
        (HERE / name).write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
