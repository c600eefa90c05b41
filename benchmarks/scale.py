"""How generation and code grow with the number of joints: chains of 2 to 50, trees of 30.

    python benchmarks/scale.py [--joints N ...]      print the table
    python benchmarks/scale.py --accept              write benchmarks/scale.json, for the page of `make bench`
    python benchmarks/scale.py --own                 measure modelgen's own figures anew, without the trace

modelgen beside Pinocchio traced with CasADi, four functions with parameters folded in: CPU time and memory
of generation, CPU time of gcc -O3, bytes, instructions per call. What takes gcc or the tracer longer than a
minute of CPU time is left out, and longer chains are not tried.
"""

from __future__ import annotations

import argparse
import json
import shutil
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from peers import build, growing, growth, pages_scale
from peers.arms import subject_of

ROOT = Path(__file__).resolve().parent.parent
ACCEPTED = ROOT / "benchmarks" / "scale.json"
WORK = ROOT / "build" / "scale"
CHAINS = (2, 3, 5, 8, 12, 20, 30, 50)
TREES = ("binary", "limbs")


def main(arguments: Sequence[str]) -> int:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description="Growth with the number of joints.")
    parser.add_argument("--joints", type=int, nargs="*", default=CHAINS, help="chains to measure")
    parser.add_argument("--accept", action="store_true", help="write benchmarks/scale.json")
    parser.add_argument("--own", action="store_true", help="measure modelgen's own figures anew")
    given = parser.parse_args(arguments)
    if min(given.joints, default=1) < 1:
        parser.error(f"a chain has at least one joint, not {min(given.joints)}")
    if given.accept and tuple(given.joints) != CHAINS:
        parser.error("--accept measures every chain")
    if missing := [tool for tool in ("gcc", "g++", "valgrind") if shutil.which(tool) is None]:
        parser.error(f"needs {missing[0]} (Debian: build-essential, valgrind)")
    if given.own:
        own()
        return 0
    (ROOT / "build" / "bench").mkdir(parents=True, exist_ok=True)
    tracer = build.tracer(ROOT / "build" / "bench")
    shapes = [("chain", n) for n in given.joints]
    if tuple(given.joints) == CHAINS:
        shapes += [(shape, 30) for shape in TREES]
    result: dict[str, Any] = {"limit": growth.LIMIT, "remarks": [], "arms": {}}
    tired: dict[str, set[str]] = {"modelgen": set(), "traced": set()}
    for shape, joints in shapes:
        print(shape, joints, file=sys.stderr, flush=True)
        case = subject_of(growing.arm(shape, joints), samples=3)
        limits = tired if shape == "chain" else {"modelgen": set(), "traced": set()}
        found = growth.measured(shape, case, tracer, WORK / case.arm.name, limits)
        result["arms"][case.arm.name] = {"shape": shape, "joints": joints, **found}
        (WORK / "scale.json").write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    print("\n".join(pages_scale.lines(result)))
    if given.accept:
        shutil.copyfile(WORK / "scale.json", ACCEPTED)
    return 0


def own() -> None:
    """Measure modelgen's part of the accepted figures anew."""
    result = json.loads(ACCEPTED.read_text(encoding="utf-8"))
    tired: dict[str, set[str]] = {"modelgen": set(), "traced": set()}
    for name, before in result["arms"].items():
        print(name, file=sys.stderr, flush=True)
        case = subject_of(growing.arm(before["shape"], before["joints"]), samples=3)
        limits = tired if before["shape"] == "chain" else {"modelgen": set(), "traced": set()}
        before |= growth.measured(before["shape"], case, None, WORK / name, limits)  # noqa: PLW2901 - in place
    ACCEPTED.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
