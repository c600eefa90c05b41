"""CPU time of `modelgen generate`: every arm, then chains of 2 to 50 revolute joints.

Each row is a process of its own, timed from the end of its imports to the files written, so that no row
profits from what an earlier one has cached. The last column of the chains is the local exponent of growth,
log(time ratio) / log(joint ratio).
"""

from __future__ import annotations

import math
import subprocess
import sys
import tempfile
from pathlib import Path

from peers.arms import OWN
from ruamel.yaml import YAML

from modelgen.resources import shipped_arms

CHAINS = (2, 3, 4, 5, 6, 7, 8, 10, 12, 15, 20, 25, 30, 40, 50)

# Imports everything, lazy imports of the command line included, before the clock starts.
TIMED = """\
import importlib, pkgutil, sys, time
import modelgen
for module in pkgutil.walk_packages(modelgen.__path__, "modelgen."):
    if not module.name.endswith("__main__"):
        importlib.import_module(module.name)
from modelgen.cli import main
start = time.process_time()
try:
    main()
except SystemExit as end:
    if end.code:
        raise
print(time.process_time() - start, file=sys.stderr)
"""


def chain(joints: int) -> str:
    """YAML of an arm with `joints` revolute joints, parallel and perpendicular axes, direct drives."""
    lines = ["schema: 1", "convention: khalil_kleinfinger", "arms:", "  chain:", "    joints:"]
    drive = "{type: direct, ratio: 100, torque_constant: 0.05}"
    for joint in range(joints):
        alpha = ("pi/2", "0", "-pi/2")[joint % 3]
        d, r = 0.1 + 0.01 * joint, (0.0, 0.2)[joint % 2]
        lines.append(f"      - {{name: j{joint + 1}, alpha: {alpha}, d: {d:.2f}, r: {r}, drive: {drive}}}")
    return "\n".join(lines) + "\n"


def seconds(arms: Path, arm: str) -> float:
    """CPU time [s] to generate one arm of a file, imports excluded. Raises RuntimeError where that fails."""
    with tempfile.TemporaryDirectory() as out:
        arguments = ["generate", str(arms), "--arm", arm, "--out", str(Path(out) / "generated")]
        command = [sys.executable, "-c", TIMED, *arguments]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"generating {arm} failed: {done.stderr.strip()}")
    return float(done.stderr.splitlines()[-1])


def main() -> None:
    """Measure and print both tables."""
    print(f"{'arm':24}{'CPU s':>8}")
    for file in (shipped_arms(), OWN):
        for arm in YAML(typ="safe").load(file)["arms"]:
            print(f"{arm:24}{seconds(file, arm):8.2f}", flush=True)

    print(f"\n{'joints in a chain':24}{'CPU s':>8}{'exponent':>10}")
    before: tuple[int, float] | None = None
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "arms.yaml"
        for joints in CHAINS:
            path.write_text(chain(joints), encoding="utf-8")
            time = seconds(path, "chain")
            growth = f"{math.log(time / before[1]) / math.log(joints / before[0]):10.2f}" if before else ""
            print(f"{joints:<24}{time:8.2f}{growth}", flush=True)
            before = joints, time


if __name__ == "__main__":
    main()
