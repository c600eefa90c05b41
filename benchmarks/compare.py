"""The generated functions beside those of other tools, on the same arms in the same states.

    python benchmarks/compare.py [ARM ...]     print the tables, and what has drifted since they were written
    python benchmarks/compare.py --accept      write benchmarks/compare.json, docs/benchmarks.md, its pictures
    python benchmarks/compare.py --own         count modelgen's own instructions anew, write them and the page
    python benchmarks/compare.py --page        write the page and its pictures from the files of figures

Needs gcc, valgrind and the packages of `pip install -e '.[bench]'`; compiling against Pinocchio's headers
takes minutes and 5 GB of memory, once (build/bench). Reports; fails only where results differ.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import json
import shutil
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from peers import batch, build, ours, pages, quoted
from peers.arms import BENCH, links_alone, names, subject
from peers.field import OURS, PINOCCHIO, RUN_TIME, Peer, measured, shared
from peers.measure import Call, instructions

ROOT = Path(__file__).resolve().parent.parent
ACCEPTED = ROOT / "benchmarks" / "compare.json"
WORK = ROOT / "build" / "bench"
_DRIFT = 0.03
_PACKAGES = ("pin", "casadi", "mujoco", "sympy", "symforce", "figaroh")


def versions() -> dict[str, str]:
    """Versions of what was measured."""
    found = {"gcc": build.run(["gcc", "-dumpfullversion"]).strip()}
    for name in _PACKAGES:
        try:
            found[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            found[name] = "not installed"
    return found


def summary(peers: dict[str, Peer]) -> dict[str, Any]:
    """Figures of one arm for the file. Times: every block of calls over modelgen's median of the same round,
    as quantiles 50, 10, 90 %, and the medians of the rounds, lowest and highest."""
    ours = {
        f: [float(np.median(blocks)) for blocks in rounds] for f, rounds in peers[OURS].nanoseconds.items()
    }
    result = {}
    for name, peer in peers.items():
        times = {}
        for f, rounds in peer.nanoseconds.items():
            ratios = [blocks / mine for blocks, mine in zip(rounds, ours[f], strict=True)]
            medians = [float(np.median(one)) for one in ratios]
            quantiles = np.percentile(np.concatenate(ratios), (50, 10, 90))
            times[f] = [round(float(x), 2) for x in (*quantiles, min(medians), max(medians))]
        result[name] = {
            "operations": peer.operations,
            "instructions": {f: round(count, 1) for f, count in peer.instructions.items()},
            "time": times,
            "costs": {key: round(value, 2) for key, value in peer.costs.items()},
        }
    return result


def rows(name: str, peers: dict[str, Peer]) -> dict[str, float]:
    """Rows of the regressor per second, by who computes them; as ratios to the loop in Python."""
    case = subject(name)

    def median(peer: Peer) -> float:
        return float(np.median(np.concatenate(peer.nanoseconds["regressor"])))

    found = {
        "modelgen, C": 1e9 * case.joints / median(peers[OURS]),
        "modelgen, NumPy": float(np.median(batch.numpy_rows(links_alone(case.arm), case))),
    }
    if PINOCCHIO in peers:
        nanoseconds = median(peers[PINOCCHIO])
        found[PINOCCHIO] = 1e9 * case.joints / nanoseconds
        found["Pinocchio, Python"] = float(np.median(batch.pinocchio_rows(case)))
    if build.package("figaroh"):
        found["FIGAROH"] = float(np.median(batch.figaroh_rows(case)))
    return {who: float(f"{value:.3g}") for who, value in found.items()}


def own(arms: dict[str, Any]) -> None:
    """Count modelgen's operations and instructions in the arms' figures anew; what was timed stays."""
    for name, peers in arms.items():
        print(name, file=sys.stderr, flush=True)
        case, folder = subject(name), WORK / name / "own"
        folder.mkdir(parents=True, exist_ok=True)
        model = links_alone(case.arm)
        ours.write(model, folder)
        counts = instructions(Call(ours.built(model, folder).program, folder, case))
        operations = ours.operations(model)
        for peer, suffix in ((OURS, ""), (RUN_TIME, "_run_time")):
            for function in peers[peer]["instructions"]:
                peers[peer]["instructions"][function] = round(counts[f"{function}{suffix}"], 1)
                peers[peer]["operations"][function] = operations[f"{function}{suffix}"]


def drifted(before: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """Instructions that are further than 3 % from the accepted ones."""
    lines = []
    for arm, peers in now.items():
        for peer, figures in peers.items():
            old = before.get(arm, {}).get(peer, {}).get("instructions", {})
            for function, count in figures["instructions"].items():
                if function in old and abs(count / old[function] - 1) > _DRIFT:
                    lines.append(f"{arm}, {peer}, {function}: {old[function]} -> {count}")
    return lines


def main(arguments: Sequence[str]) -> int:
    """Measure, print, compare or accept."""
    parser = argparse.ArgumentParser(description="Generated functions beside those of other tools.")
    parser.add_argument("arm", nargs="*", help="arms, by default every one")
    parser.add_argument("--accept", action="store_true", help="write the tables")
    parser.add_argument("--own", action="store_true", help="count modelgen's own instructions anew")
    parser.add_argument("--page", action="store_true", help="write the page from the files of figures alone")
    given = parser.parse_args(arguments)
    if given.own:
        result = json.loads(ACCEPTED.read_text(encoding="utf-8"))
        own(result["arms"])
        ACCEPTED.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    if given.page or given.own:
        pages.write(json.loads(ACCEPTED.read_text(encoding="utf-8")), ACCEPTED.parent, ROOT / "docs")
        return 0
    if unknown := [name for name in given.arm if name not in names()]:
        parser.error(f"unknown arm {unknown[0]!r}, expected one of {', '.join(names())}")
    if given.accept and given.arm:
        parser.error("--accept measures every arm")
    if missing := [tool for tool in ("gcc", "g++", "valgrind") if shutil.which(tool) is None]:
        parser.error(f"needs {missing[0]} (Debian: build-essential, valgrind)")
    WORK.mkdir(parents=True, exist_ok=True)
    common = shared(WORK)
    arms, batches = {}, {}
    for name in given.arm or names():
        print(name, file=sys.stderr, flush=True)
        peers = measured(name, common, WORK / name)
        arms[name] = summary(peers)
        if name in BENCH:
            batches[name] = rows(name, peers)
    result = {"versions": versions(), "arms": arms, "rows_per_second": batches}
    result["quoted"] = quoted.counted()
    print(pages.document(result, ACCEPTED.parent))
    if ACCEPTED.exists():
        before = json.loads(ACCEPTED.read_text(encoding="utf-8"))["arms"]
        print("\n".join(drifted(before, arms)), file=sys.stderr)
    if given.accept:
        ACCEPTED.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
        pages.write(result, ACCEPTED.parent, ROOT / "docs")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
