"""CPU time of a diagnosis over joints, candidates and samples: python benchmarks/diagnosis_scale.py [DIR].

Simulated arms of tests/hidden with nothing hidden, two training records and a test record each; every
candidate is tried once. DIR keeps the logs. Writes docs/diagnosis_scale.svg, prints the table.
"""

from __future__ import annotations

import importlib
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from modelgen.dataset import DatasetThresholds
from modelgen.description import load
from modelgen.diagnosis import decision as deciding
from modelgen.diagnosis.pipeline import diagnose, records
from modelgen.effects import known_effects
from modelgen.figures import COLOURS, figure, svg

JOINTS = ("direct2", "direct3", "mixed4", "mixed5", "direct6")
SHARES = (8, 4, 2, 1)  # every so many of the candidates of an arm with three joints
PERIODS = (2, 4, 8, 16)  # of 10 s, at RATE, of an arm with two joints
RATE = 250.0
decision: Any = deciding  # the one place where a measurement reaches in: candidates are left out
Point = tuple[float, float]


def timed(folder: Path, arm: str, periods: int = 3, every: int = 1) -> tuple[int, int, float]:
    """Candidates, samples of all records, CPU time [s] of the diagnosis, the better of two runs."""
    cases = importlib.import_module("hidden.cases")
    place = folder / f"{arm}_{periods}"
    if not (place / "check.csv").exists():
        cases.make(cases.Case(arm, 80_000, (), "motor", RATE, periods), place)
    described = load(place / "arms.yaml", known_effects())["arm"]
    train = [str(place / f"train_{x}.csv") for x in "ab"]
    found = records(described, train, [str(place / "test.csv")], None, DatasetThresholds())
    pools: list[int] = []
    every_one = decision.candidates

    def some(*given: Any) -> list[Any]:
        pool: list[Any] = every_one(*given)[::every]
        pools.append(len(pool))
        return pool

    seconds = []
    decision.candidates = some
    try:
        for _ in range(2):
            begin = time.process_time()
            diagnose(described, found)
            seconds.append(time.process_time() - begin)
    finally:
        decision.candidates = every_one
    return pools[-1], sum(len(r.t) for r in found), min(seconds)


def slope(points: Sequence[Point]) -> float:
    """Exponent of the power law through the points."""
    x, y = np.log(np.array(points)).T
    return float(np.polyfit(x, y, 1)[0])


def main(folder: Path) -> None:
    """Measure, draw, print."""
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))
    timed(folder, JOINTS[0])  # compiles what is compiled once
    by: dict[str, list[Point]] = {"joints": [], "candidates": [], "samples": []}
    print("| | candidates | samples | CPU time over that of two joints |\n|---|---|---|---|")
    unit = 0.0
    for arm in JOINTS:
        candidates, samples, seconds = timed(folder, arm)
        unit = unit or seconds
        by["joints"].append((int(arm[-1]), seconds / unit))
        print(f"| {arm[-1]} joints | {candidates} | {samples} | {seconds / unit:.2f} |", flush=True)
    for every in SHARES:
        candidates, samples, seconds = timed(folder, "direct3", every=every)
        by["candidates"].append((candidates, seconds / unit))
        print(f"| 3 joints | {candidates} | {samples} | {seconds / unit:.2f} |", flush=True)
    for periods in PERIODS:
        candidates, samples, seconds = timed(folder, "direct2", periods)
        by["samples"].append((samples, seconds / unit))
        print(f"| 2 joints | {candidates} | {samples} | {seconds / unit:.2f} |", flush=True)
    print(f"unit: {unit:.2f} s of CPU time on this machine", file=sys.stderr)
    made, axes = figure(1, 3, (9.0, 2.8))
    for axis, (name, points) in zip(axes[0], by.items(), strict=True):
        x, y = zip(*points, strict=True)
        axis.loglog(x, y, marker="o", color=COLOURS[0], label=f"exponent {slope(points):.2f}")
        axis.set_xlabel(name)
        axis.set_xticks(x, [f"{v:,.0f}" for v in x])
        axis.minorticks_off()
        axis.legend(loc="upper left")
    times = [y for points in by.values() for _, y in points]
    for axis in axes[0]:
        axis.set_ylim(min(times) / 1.5, 1.5 * max(times))
    axes[0, 0].set_ylabel("CPU time over that of two joints")
    target = Path(__file__).resolve().parent.parent / "docs" / "diagnosis_scale.svg"
    target.write_text(svg(made), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with tempfile.TemporaryDirectory() as scratch:
            main(Path(scratch))
