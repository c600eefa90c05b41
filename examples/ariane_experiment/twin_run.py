"""The experiment from the trajectory to the table: excite, track and record, identify, validate.

    python examples/ariane_experiment/twin_run.py     two minutes: tables on stdout, pictures beside this file

README.md explains it and has the figures.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
from twin_pictures import comparison, predictions, tracking
from twin_records import (
    ARM,
    ARMS,
    HERE,
    recorded,
    set_points,
    write_calibration,
    write_log,
)

from modelgen.description import load

Array = NDArray[np.float64]

BUILD = HERE / "build"
SEEDS = {"train": 1, "test": 2}  # of the trajectory and of the noise
PAPER = {"without": (0.129, 0.154, 0.152), "with": (0.117, 0.128, 0.122)}  # A, Table IV


def modelgen(*arguments: str) -> None:
    """Run the command line; its own messages are shown where it fails."""
    call = [sys.executable, "-m", "modelgen", *arguments]
    done = subprocess.run(call, cwd=HERE.parents[1], capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"{' '.join(call)}\n{done.stderr}")


def excited(part: str) -> Path:
    """Set-points of an optimised trajectory: 3 joints, 5 harmonics, 80 s, 10 Hz, the limits of Table III."""
    name = BUILD / f"{part}_trajectory.csv"
    seed = str(SEEDS[part])
    modelgen(
        "excite", str(ARMS), "--arm", ARM, "--rate", "10", "--starts", "4", "--seed", seed, "--out", str(name)
    )
    return name.with_name(f"{part}_trajectory_set_points.csv")


def identified(kind: str, *options: str) -> dict[str, Any]:
    """identification.json of the train record, validated on the test record."""
    logs = ["--train", str(BUILD / "train.csv"), "--test", str(BUILD / "test.csv")]
    mapping = ["--mapping", str(HERE / "mapping.yaml")]
    modelgen("identify", str(ARMS), "--arm", ARM, *logs, *mapping, "--out", str(BUILD / kind), *options)
    found: dict[str, Any] = json.loads((BUILD / kind / "identification.json").read_text(encoding="utf-8"))
    return found


def main() -> None:
    """Run, print, draw."""
    console = Console(stderr=True)
    columns = TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn()
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("excite", total=6)
        recordings, points = {}, {}
        for part, seed in SEEDS.items():
            bar.update(task, description=f"excite: {part}")
            points[part] = excited(part)
            bar.update(task, advance=1, description=f"track and record: {part}")
            recordings[part] = recorded(points[part], seed)
            write_log(recordings[part], BUILD / f"{part}.csv", recordings[part].sample)
            bar.advance(task)
        write_calibration(recordings["train"], BUILD)
        found: dict[str, Any] = {}
        for kind, options in (("paper", ["--preset", "paper"]), ("filtered", ["--cutoff", "1"])):
            bar.update(task, description=f"identify: {kind}")
            found[kind] = identified(kind, "--compare-drives", *options)
            bar.advance(task)
    _print(found)
    t, wanted = set_points(points["train"])
    (HERE / "tracking.svg").write_text(tracking(t, wanted, recordings["train"]), encoding="utf-8")
    files = BUILD / "train.csv", BUILD / "test.csv", HERE / "mapping.yaml"
    picture = comparison(predictions(load(ARMS)[ARM], *files))
    (HERE / "validation.svg").write_text(picture, encoding="utf-8")
    for name in ("tracking.svg", "validation.svg"):
        print(f"wrote {HERE / name}")


def _print(found: dict[str, Any]) -> None:
    for title, kind in (("current not filtered", "paper"), ("current and regressor below 1 Hz", "filtered")):
        own = np.array(found[kind]["test"]["rmse"])
        print(f"RMSE of the current on the test record [A], {title}:")
        print(f"  {'the arm as described':34s}" + "  ".join(f"{x:.3f}" for x in own))
        for other in found[kind]["without_drives"]:
            pairs = zip(other["rmse"], own, strict=True)
            print(
                f"  {other['model']:34s}"
                + "  ".join(f"{x:.3f} ({100 * (y / x - 1):+.0f} %)" for x, y in pairs)
            )
    for kind, values in PAPER.items():
        print(f"  {f'the paper, {kind} drives':34s}" + "  ".join(f"{x:.3f}" for x in values))
    print(found["filtered"]["verdict"])


if __name__ == "__main__":
    main()
