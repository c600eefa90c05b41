"""Derivatives and combined functions beside Pinocchio, and MuJoCo's dynamics alone beside its pipelines.

    python benchmarks/control.py [ARM ...]     print the tables
    python benchmarks/control.py --accept      write benchmarks/control.json, for the page of `make bench`
    python benchmarks/control.py --own         count modelgen's own instructions anew, without the others

The three bench arms, rigid links, parameters folded in, x86-64-v3; instructions per call counted by callgrind
over 50 states, results compared to 1e-10. Compiling Pinocchio takes minutes, once (build/bench).
"""

from __future__ import annotations

import argparse
import json
import shutil
import sys
from collections.abc import Sequence
from pathlib import Path

from peers import build, mujoco_model, pages_control
from peers.arms import BENCH, names, subject
from peers.control import Programs, measured

ROOT = Path(__file__).resolve().parent.parent
ACCEPTED = ROOT / "benchmarks" / "control.json"
WORK = ROOT / "build" / "control"
_SAMPLES = 50


def main(arguments: Sequence[str]) -> int:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description="Derivatives and combined functions.")
    parser.add_argument("arm", nargs="*", help="arms, by default the bench arms")
    parser.add_argument("--accept", action="store_true", help="write benchmarks/control.json")
    parser.add_argument("--own", action="store_true", help="count modelgen's own instructions anew")
    given = parser.parse_args(arguments)
    if unknown := [name for name in given.arm if name not in names()]:
        parser.error(f"unknown arm {unknown[0]!r}, expected one of {', '.join(names())}")
    if given.accept and given.arm:
        parser.error("--accept measures the bench arms")
    if missing := [tool for tool in ("gcc", "g++", "valgrind") if shutil.which(tool) is None]:
        parser.error(f"needs {missing[0]} (Debian: build-essential, valgrind)")
    if given.own:
        result = json.loads(ACCEPTED.read_text(encoding="utf-8"))
        for name, before in result.items():
            for figures, found in measured(subject(name, _SAMPLES), Programs(), WORK / name).items():
                before[figures] |= found
        ACCEPTED.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
        return 0
    bench = ROOT / "build" / "bench"
    bench.mkdir(parents=True, exist_ok=True)
    programs = Programs(
        mujoco_model.harness(bench) if build.package("mujoco") else None,
        build.derivatives(bench),
        build.tracer(bench),
    )
    result = {}
    for name in given.arm or BENCH:
        print(name, file=sys.stderr, flush=True)
        result[name] = measured(subject(name, _SAMPLES), programs, WORK / name)
    print("\n".join(pages_control.lines(result)))
    if given.accept:
        ACCEPTED.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
