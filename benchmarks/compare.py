"""The generated functions beside those of other tools, on the same arms in the same states.

    python benchmarks/compare.py [ARM ...]     print the tables, and what has drifted since they were written
    python benchmarks/compare.py --accept      write benchmarks/compare.json, docs/benchmarks.md, its pictures

Needs gcc, valgrind and the packages of `pip install 'modelgen[bench]'`; compiling against Pinocchio's headers
takes minutes and 5 GB of memory, once (build/bench). Reports; fails only where results differ.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from peers import batch, build, pages
from peers.arms import BENCH, SHIPPED, links_alone, subject
from peers.field import OURS, PINOCCHIO, Peer, measured, shared

ROOT = Path(__file__).resolve().parent.parent
ACCEPTED = ROOT / "benchmarks" / "compare.json"
WORK = ROOT / "build" / "bench"
_DRIFT = 0.03
_PACKAGES = ("pin", "casadi", "mujoco", "sympy", "figaroh")


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
    """Figures of one arm for the file: times as quantiles of the ratio to modelgen's median."""
    ours = {f: float(np.median(times)) for f, times in peers[OURS].nanoseconds.items()}
    return {
        name: {
            "instructions": {f: round(count, 1) for f, count in peer.instructions.items()},
            "time": {
                f: [round(float(x), 2) for x in np.percentile(times, (50, 10, 90)) / ours[f]]
                for f, times in peer.nanoseconds.items()
            },
            "bytes": peer.bytes,
            "generation": None if peer.generation is None else round(peer.generation, 2),
        }
        for name, peer in peers.items()
    }


def rows(name: str, peers: dict[str, Peer]) -> dict[str, float]:
    """Rows of the regressor per second, by who computes them; as ratios to the loop in Python."""
    case = subject(name)
    found = {
        "modelgen, C": 1e9 * case.joints / float(np.median(peers[OURS].nanoseconds["regressor"])),
        "modelgen, NumPy": float(np.median(batch.numpy_rows(links_alone(case.arm), case))),
    }
    if PINOCCHIO in peers:
        nanoseconds = float(np.median(peers[PINOCCHIO].nanoseconds["regressor"]))
        found[PINOCCHIO] = 1e9 * case.joints / nanoseconds
        found["Pinocchio, Python"] = float(np.median(batch.pinocchio_rows(case)))
    if build.package("figaroh"):
        found["FIGAROH"] = float(np.median(batch.figaroh_rows(case)))
    return {who: float(f"{value:.3g}") for who, value in found.items()}


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
    parser.add_argument("arm", nargs="*", help="arms, by default the three bench arms and five others")
    parser.add_argument("--accept", action="store_true", help="write the tables")
    given = parser.parse_args(arguments)
    WORK.mkdir(parents=True, exist_ok=True)
    common = shared(WORK)
    arms, batches = {}, {}
    for name in given.arm or (*BENCH, *SHIPPED):
        print(name, file=sys.stderr, flush=True)
        peers = measured(name, common, WORK / name)
        arms[name] = summary(peers)
        if name in BENCH:
            batches[name] = rows(name, peers)
    result = {"versions": versions(), "arms": arms, "rows_per_second": batches}
    print(pages.document(result))
    if ACCEPTED.exists():
        before = json.loads(ACCEPTED.read_text(encoding="utf-8"))["arms"]
        print("\n".join(drifted(before, arms)), file=sys.stderr)
    if given.accept:
        ACCEPTED.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
        pages.write(result, ROOT / "docs")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
