"""libFuzzer on the generated C of an arm: `python tests/safety/fuzz.py --help`. Needs clang."""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from safety import exercise
from safety.eva import written

from modelgen.description import load
from modelgen.effects import known_effects
from modelgen.functions import Model, build_model
from modelgen.resources import shipped_arms

ARMS = ("ariane4", "ariane6", "ur10e", "two_fingers", "scara")


def fuzz(
    model: Model, real: str, seconds: int, folder: Path, optimise: str = "-O1"
) -> subprocess.CompletedProcess[str]:
    """Build the target in `folder`, which holds the arm's C files, and run it."""
    source = exercise.write(model, real, folder)
    target = folder / f"fuzz_{real}"
    sanitizers = exercise.SANITIZERS.replace("=", "=fuzzer,", 1)
    command = ["clang", optimise, "-g", "-DFUZZER", sanitizers, "-fno-sanitize-recover=all"]
    command += [*exercise.flags(model, real, folder), str(source), "-o", str(target), "-lm"]
    built = subprocess.run(command, capture_output=True, text=True, check=False)
    if built.returncode != 0:
        return built
    options = [f"-max_total_time={seconds}", "-max_len=1024", "-seed=1", f"-artifact_prefix={folder}/"]
    return subprocess.run([str(target), *options], capture_output=True, text=True, check=False)


def main(arguments: Sequence[str] | None = None) -> int:
    """Fuzz the arms in float and double; 1 where a call breaks a promise or is undefined."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("--arm", action="append", help=f"default: {', '.join(ARMS)}")
    parser.add_argument("--seconds", type=int, default=60, help="for each arm and type")
    given = parser.parse_args(arguments)
    arms = load(shipped_arms(), known_effects())
    failed = 0
    with tempfile.TemporaryDirectory() as temporary, ThreadPoolExecutor(os.cpu_count()) as pool:
        runs = {}
        for name in given.arm or ARMS:
            model = build_model(arms[name])
            folder = written(model, Path(temporary) / name)
            for real in ("float", "double"):
                runs[f"{name} ({real})"] = pool.submit(fuzz, model, real, given.seconds, folder)
        for title, run in runs.items():
            done = run.result()
            failed += done.returncode != 0
            last = done.stderr.strip().splitlines()[-1:] if done.returncode == 0 else [done.stderr]
            sys.stdout.write(f"{title}: {''.join(last)}\n")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
