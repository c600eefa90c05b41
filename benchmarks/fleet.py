"""A fleet of 200 simulated arms diagnosed as one job: python benchmarks/fleet.py DIR [--units N] [--jobs N].

The arms, with two joints each, and what is hidden in them come from tests/hidden, which shares no code with
modelgen. Some units have logs that cannot be used. Units that are there are kept: the script and the fleet
can be interrupted and called again. Of 200 units the causes are drawn: docs/fleet_causes.svg.
"""

from __future__ import annotations

import argparse
import importlib
import json
import resource
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from modelgen.figures import figure, svg
from modelgen.fleet.overview import causes
from modelgen.jobs import Where, run

# Arm, effect, joint, magnitude: for an error up to 1.3 times as large, at the arms that they were tuned on.
HIDDEN = (
    ("direct2", "stribeck_friction", 2, 0.52),
    ("direct2", "position_dependent_friction", 2, 0.14),
    ("direct2", "torque_ripple", 1, 0.66),
    ("direct2", "friction_offset", 1, 0.06),
    ("direct2", "time_delay", 2, 3.4),
    ("levered2", "nonlinear_viscous_friction", 1, 1.42),
    ("levered2", "lever_geometry", 2, 2.0),
    ("levered2", "spring", 1, 0.62),
    ("levered2", "fluid_drag", 2, 0.38),
    ("levered2", "load_dependent_friction", 1, 1.09),
    ("mixed2", "friction_warm_up", 2, 0.15),
    ("mixed2", "presliding", 2, 0.05),
    ("mixed2", "asymmetric_viscous_friction", 1, 0.47),
    ("direct2", "hard_spot", 1, 0.15),  # in no catalogue
)
ARMS = ("direct2", "levered2", "mixed2")
# By joint; causes of the whole arm come last.
_JOINTS = ("#123a66", "#4f8acb", "#a9cbee", "#d1661a", "#f0b27a", "#7a4a1d", "#666666")
_ARM = "#8a4fa3"
DRAWN = Path(__file__).resolve().parent.parent / "docs" / "fleet_causes.svg"
PERIODS, RATE = 3, 250.0
FLEET = """schema: 1
patterns:
  - arms: "units/{unit}/arms.yaml"
    train: "units/{unit}/train_*.csv"
    test: "units/{unit}/test.csv"
"""


def make(job: tuple[str, int]) -> tuple[str, list[Any]]:
    """Name and truth of a unit: every fifth has nothing hidden, every 25th a log that cannot be used."""
    folder, k = Path(job[0]), job[1]
    cases = importlib.import_module("hidden.cases")
    name = f"u{k:03}"
    arm = ARMS[k // 5 % len(ARMS)]
    hidden: list[Any] = []
    if k % 5:
        arm, effect, joint, magnitude = HIDDEN[(k - k // 5 - 1) % len(HIDDEN)]
        hidden = [cases.Hidden(effect, joint, 1.3, magnitude)]
    unit = folder / "units" / name
    if not (unit / "check.csv").exists():
        cases.make(cases.Case(arm, 70_000 + k, tuple(hidden), "motor", RATE, PERIODS), unit)
        if k % 25 == 24:
            _spoil(unit / "train_b.csv", k // 25)
    return name, ["unusable"] if k % 25 == 24 else [hidden[0].effect, hidden[0].joint] if hidden else []


def _spoil(log: Path, kind: int) -> None:
    """What happens to logs: cut, a word in a column, a column lost, empty."""
    lines = log.read_text(encoding="ascii").splitlines()
    middle = len(lines) // 2
    if kind % 4 == 0:
        lines = lines[:40]
    elif kind % 4 == 1:
        lines[middle] = lines[middle].rpartition(",")[0] + ",error"
    elif kind % 4 == 2:
        lines = [line.rpartition(",")[0] for line in lines]
    else:
        lines = []
    log.write_text("\n".join(lines) + "\n", encoding="ascii")


def main() -> None:
    """Make, diagnose, compare with the truth."""
    parser = argparse.ArgumentParser(description=str(__doc__).split("\n", maxsplit=1)[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--units", type=int, default=200)
    parser.add_argument("--jobs", type=int)
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))
    made = run(make, [(str(given.folder), k) for k in range(given.units)], Where(given.jobs))
    truth = dict(unit for _, unit in made)
    (given.folder / "fleet.yaml").write_text(FLEET, encoding="utf-8")
    out = given.folder / "out"
    command = [sys.executable, "-m", "modelgen", "fleet", str(given.folder / "fleet.yaml"), "--out", str(out)]
    begin, before = time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN)
    jobs = ["--jobs", str(given.jobs)] if given.jobs else []
    said = json.loads(subprocess.run([*command, *jobs, "--json"], check=True, stdout=subprocess.PIPE).stdout)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(f"{said['units']} units, {said['kept']} kept: {time.perf_counter() - begin:.0f} s, CPU {cpu:.0f} s")
    print(json.dumps(said["verdicts"]))
    counts: Counter[tuple[str, str]] = Counter()
    rows = []
    for name, hidden in truth.items():
        rows.append(json.loads((out / "units" / name / "unit.json").read_text(encoding="utf-8"))["row"])
        counts[_kind(hidden), _judged(hidden, rows[-1])] += 1
    if given.units == parser.get_default("units"):
        DRAWN.write_text(_cause_bars(rows), encoding="utf-8", newline="\n")
    for (kind, judged), count in sorted(counts.items()):
        print(f"{kind:12} {judged:28} {count}")


def _cause_bars(rows: Sequence[dict[str, Any]]) -> str:
    """Named causes by effect, the joints in shades, as SVG."""
    found, effects = Counter[tuple[str, int | None]](), Counter[str]()
    for (effect, joint, _), count in causes(rows).items():
        found[effect, joint] += count
        effects[effect] += count
    order = sorted(effects, key=lambda name: (effects[name], name))
    joints = sorted({joint for _, joint in found if joint is not None})
    places: list[int | None] = [*joints, *([None] if any(joint is None for _, joint in found) else [])]
    made, axes = figure(1, 1, (7.4, max(1.2, 0.2 + 0.2 * len(places), 0.7 + 0.27 * len(order))))
    axis = axes[0, 0]
    start = [0] * len(order)
    for place in places:
        widths = [found[effect, place] for effect in order]
        colour = _ARM if place is None else _JOINTS[min(joints.index(place), len(_JOINTS) - 1)]
        label = "whole arm" if place is None else f"joint {place}"
        axis.barh(range(len(order)), widths, left=start, color=colour, height=0.72, label=label)
        start = [a + b for a, b in zip(start, widths, strict=True)]
    for k, total in enumerate(start):
        axis.annotate(str(total), (total, k), (4, 0), textcoords="offset points", va="center")
    axis.set_yticks(range(len(order)), order)
    axis.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=8)
    axis.set_xlim(0, 1.12 * max(start))
    axis.set_xlabel("times named")
    axis.xaxis.get_major_locator().set_params(integer=True)
    axis.grid(False, axis="y")
    axis.set_axisbelow(True)
    return svg(made)


def _kind(hidden: list[Any]) -> str:
    if hidden == ["unusable"]:
        return "unusable"
    return "nothing" if not hidden else "outside" if hidden[0] == "hard_spot" else "cause"


def _judged(hidden: list[Any], row: dict[str, Any]) -> str:
    if row.get("error"):
        return "failed"
    named = list(zip(row["causes"], row["joints"], strict=True))
    if _kind(hidden) != "cause" or not named:
        return str(row["verdict"])
    effect, joint = hidden
    whole = effect == "fluid_drag"  # of the arm, named without a joint
    right = [(e, j) for e, j in named if e == effect and (j == joint or whole)]
    if right:
        return "named exactly" if len(named) == 1 else "named, and another"
    alike = [name for names in row["aliases"] + row["ambiguous_with"] for name in names]
    return "among the rivals" if any(a.startswith(effect) for a in alike) else "another named"


if __name__ == "__main__":
    main()
