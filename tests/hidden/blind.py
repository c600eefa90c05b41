"""python -m hidden.blind [--seed N] [--train N] [--only null,single] [--limit N] [--jobs N]

The full matrix of hidden effects on all cores, one line of JSON a case in tests/hidden/runs/SEED.jsonl: what
is there is not run again. Writes docs/diagnosis.md and its pictures, a column for each number of training
records that was run. Run from the repository with tests/ on the path, as `make blind` does; the seed is the
commit's hash unless one is given.
"""

from __future__ import annotations

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
import zlib
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from itertools import combinations, zip_longest
from pathlib import Path
from random import Random
from typing import Any

from joblib import Parallel, delayed
from rich.progress import Progress

from hidden import blind_report
from hidden.arms import DRIVEN
from hidden.cases import RECORDS
from hidden.drawing import draw
from hidden.effects import CATALOGUE, OUTSIDE
from hidden.native import PlantError
from hidden.running import CommandError, run

RUNS = Path(__file__).with_name("runs")
STRENGTHS = (1.05, 1.10, 1.30)
NULLS, PAIRS, REPEATS = 200, 30, 3
TRAIN = 4  # records: a fit to two takes up much of what costs 5 % on another motion
SMALL = tuple(name for name in DRIVEN if name not in ("direct6", "mixed5"))
FREE = ("pendulum1", "pendulum2")
FREE_EFFECTS = ("stribeck_friction", "nonlinear_viscous_friction", "spring")
COARSE_EFFECTS = tuple(name for name in CATALOGUE if name not in ("backlash", "joint_flexibility"))


@dataclass(frozen=True)
class Item:
    """One cell of the matrix, once. group: null, single, pair, outside, coarse, free, link_side."""

    group: str
    effects: tuple[str, ...]
    strength: float
    number: int
    encoder: str = "motor"

    @property
    def key(self) -> str:
        return f"{self.group}/{'+'.join(self.effects) or 'none'}/{self.strength:g}/{self.number}"


def matrix() -> list[Item]:
    """Every item, groups interleaved: a run that is stopped early has some of each."""
    groups: dict[str, list[Item]] = {
        "null": [Item("null", (), 1.0, k) for k in range(NULLS)],
        "single": [
            Item("single", (effect,), strength, k)
            for k in range(REPEATS)
            for effect in CATALOGUE
            for strength in STRENGTHS
        ],
        "outside": [Item("outside", (effect,), 1.3, k) for k in range(20) for effect in OUTSIDE],
        "pair": [Item("pair", _two(k), 1.15, k) for k in range(PAIRS)],
        "coarse": [
            Item("coarse", effects, 1.3, k, "coarse")
            for k, effects in enumerate([(), *((name,) for name in COARSE_EFFECTS)] * 2)
        ],
        "link_side": [
            Item("link_side", (effect,), 1.3, k, "joint")
            for k in range(10)
            for effect in ("backlash", "joint_flexibility")
        ],
        "free": [
            Item("free", effects, 1.3, k)
            for k, effects in enumerate([(), *((name,) for name in FREE_EFFECTS)] * 6)
        ],
    }
    Random(1).shuffle(groups["single"])
    rows = zip_longest(*(_spread(items, NULLS) for items in groups.values()))
    return [item for row in rows for chunk in row if chunk for item in chunk]


def _spread(items: list[Item], slots: int) -> Iterator[list[Item]]:
    for k in range(slots):
        yield items[len(items) * k // slots : len(items) * (k + 1) // slots]


def _two(k: int) -> tuple[str, str]:
    """The k-th of some pairs of different effects, the same for every seed."""
    names = [name for name in CATALOGUE if name not in ("backlash", "joint_flexibility", "payload_change")]
    pairs = list(combinations(names, 2))
    Random(0).shuffle(pairs)
    return pairs[k]


def run_item(item: Item, seed: int, train: int, head: str) -> dict[str, Any]:
    """The line of a case; an error of the plant or of the command line is a line too.

    train: number of training records; the arm, the effect and the first two records do not depend on it.
    head: commit that is checked out.
    """
    own = zlib.crc32(f"{seed}/{item.key}".encode())
    names = FREE if item.group == "free" else SMALL if item.number % 5 else DRIVEN
    line: dict[str, Any] = {"key": item.key, "seed": seed, "train": train, "commit": head, **asdict(item)}
    folder = Path(tempfile.mkdtemp(prefix="hidden-"))
    try:
        case = draw(own, item.effects, item.strength, names, item.encoder, train)
        outcome, label, seconds = run(case, folder / "case")
        line |= {"case": asdict(case), **asdict(outcome), "reached": label.strength}
        line |= {"shown": label.shown, "seconds": seconds}
    except PlantError as error:
        line["no_case"] = str(error)
    except CommandError as error:
        line["failed"] = str(error)
    finally:
        shutil.rmtree(folder)
    return line


def commit() -> str:
    """The hash of the commit that is checked out."""
    return subprocess.run(
        ["git", "rev-parse", "HEAD"], capture_output=True, text=True, check=True
    ).stdout.strip()


def kept(path: Path) -> dict[tuple[str, int], dict[str, Any]]:
    """Lines of earlier runs by key and number of training records, the last one of each."""
    texts = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    return {(line["key"], line["train"]): line for line in map(json.loads, texts)}


def main() -> int:
    """Exit status 0; 1 where the command line failed on a case."""
    assert __doc__ is not None
    parser = argparse.ArgumentParser(prog="hidden.blind", description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--seed", type=lambda text: int(text, 0), default=None)
    counts = range(2, len(RECORDS) - 1)
    parser.add_argument("--train", type=int, default=TRAIN, choices=counts, help="number of training records")
    parser.add_argument("--only", default="", help="groups, separated by commas")
    parser.add_argument("--limit", type=int, default=None, help="stop after so many new cases")
    parser.add_argument("--jobs", type=int, default=-1)
    parser.add_argument("--out", type=Path, default=RUNS)
    parser.add_argument("--docs", type=Path, default=Path("docs"))
    given = parser.parse_args()
    head = commit()
    seed = int(head[:8], 16) if given.seed is None else given.seed
    given.out.mkdir(parents=True, exist_ok=True)
    path = given.out / f"{seed}.jsonl"
    lines = kept(path)
    done = {key for (key, train), line in lines.items() if train == given.train and "failed" not in line}
    groups = set(filter(None, given.only.split(",")))
    todo = [item for item in matrix() if item.key not in done and (not groups or item.group in groups)]
    todo = todo[: given.limit]
    with Progress() as progress, path.open("a", encoding="utf-8") as file:
        task = progress.add_task(f"seed {seed}, {given.train} training records", total=len(todo))
        results = Parallel(n_jobs=given.jobs, return_as="generator_unordered")(
            delayed(run_item)(item, seed, given.train, head[:12]) for item in todo
        )
        for line in results:
            text = json.dumps(line)
            file.write(text + "\n")
            file.flush()
            lines[line["key"], line["train"]] = json.loads(text)  # as one that was read: lists, no tuples
            progress.advance(task)
    blind_report.write(list(lines.values()), given.docs, len(matrix()))
    return 1 if any("failed" in line for line in lines.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
