"""Do the claimed standard deviations hold? The experiment again and again, only the noise another.

    python examples/ariane_experiment/twin_coverage.py          50 noise seeds, some minutes on one processor
    python examples/ariane_experiment/twin_coverage.py --seeds 10

Exit status 1 where the 95 % intervals cover the true base parameters in fewer than 90 or more than 99 % of
cases, or where a claimed standard deviation is less than 0.7 or more than 1.5 times the one found.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from joblib import Parallel, delayed
from numpy.typing import NDArray
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from twin_records import ARM, ARMS, PERIODS, as_record, recorded, truth
from twin_run import BUILD, excited

from modelgen.dataset import Settings, choose, prepare
from modelgen.description import Arm, load
from modelgen.identification import identify

Array = NDArray[np.float64]
CUTOFF = 1.0  # Hz
COVERED, RATIO = (0.90, 0.99), (0.7, 1.5)


@dataclass(frozen=True)
class Coverage:
    """names: (p,); true: (p,); value, std: (seeds, p), in the parameters' units."""

    names: tuple[str, ...]
    true: Array
    value: Array
    std: Array

    @property
    def covered(self) -> Array:
        """Share of the 95 % intervals that hold the truth, by parameter (p,)."""
        return np.asarray(np.mean(np.abs(self.value - self.true) < 1.96 * self.std, axis=0))

    @property
    def ratio(self) -> Array:
        """Claimed over empirical standard deviation, by parameter (p,)."""
        return np.asarray(self.std.mean(axis=0) / self.value.std(axis=0, ddof=1))

    @property
    def bias(self) -> Array:
        """Mean error over the empirical standard deviation, by parameter (p,)."""
        return np.asarray((self.value.mean(axis=0) - self.true) / self.value.std(axis=0, ddof=1))


@cache
def described() -> Arm:
    """The arm, read once: its model is then built once too."""
    return load(ARMS)[ARM]


def estimated(points: Path, seed: int, periods: int) -> tuple[Array, Array]:
    """Base parameters and their standard deviations (p,) from one record."""
    arm = described()
    log = as_record(recorded(points, seed, periods), arm)
    found = identify([prepare(log, choose(log, Settings(cutoff=CUTOFF)))], arm)
    std = [np.nan if e.std is None else e.std for e in found.estimates]
    return np.array([e.value for e in found.estimates]), np.array(std)


def coverage(points: Path, seeds: int, periods: int = PERIODS, jobs: int = -1) -> Coverage:
    """Identify from `seeds` records that differ in their noise alone."""
    console = Console(stderr=True)
    columns = TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn()
    found = []
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        task = bar.add_task("noise seeds", total=seeds)
        work = (delayed(estimated)(points, seed, periods) for seed in range(seeds))
        for one in Parallel(jobs, return_as="generator")(work):
            found.append(one)
            bar.advance(task)
    true = truth()
    value, std = (np.array(x) for x in zip(*found, strict=True))
    return Coverage(tuple(true), np.array(list(true.values())), value, std)


def main() -> int:
    """Run, print; the exit status."""
    parser = argparse.ArgumentParser(description="Coverage of the intervals over noise seeds.")
    parser.add_argument("--seeds", type=int, default=50)
    seeds = parser.parse_args().seeds
    if seeds < 2:
        parser.error(f"--seeds: found {seeds}, expected at least 2")
    points = BUILD / "train_trajectory_set_points.csv"
    c = coverage(points if points.exists() else excited("train"), seeds)
    print("parameter        true    mean found   std claimed / found   bias / std   covered %")
    for k, name in enumerate(c.names):
        mean = c.value[:, k].mean()
        figures = f"{c.ratio[k]:21.2f} {c.bias[k]:12.2f} {100 * c.covered[k]:11.0f}"
        print(f"{name:8s} {c.true[k]:12.4g} {mean:13.4g} {figures}")
    share, low, high = float(c.covered.mean()), float(c.ratio.min()), float(c.ratio.max())
    print(f"{seeds} seeds: {100 * share:.1f} % of the intervals hold the truth")
    print(f"claimed over found standard deviation: {low:.2f} to {high:.2f}")
    return int(not (COVERED[0] <= share <= COVERED[1] and RATIO[0] < low and high < RATIO[1]))


if __name__ == "__main__":
    raise SystemExit(main())
