"""One case from its drawing to its verdict: the command line sees the logs, then the label is opened."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from hidden.arms import FREE
from hidden.cases import Case, Label, make, seal, unseal
from hidden.judging import Outcome, judge
from hidden.recovery import reachable

ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


class CommandError(RuntimeError):
    """modelgen diagnose did not do its work."""


def diagnose(folder: Path, name: str) -> tuple[dict[str, Any], float]:
    """The answer of the command line on the logs in the folder, and the seconds it took."""
    command = [sys.executable, "-m", "modelgen", "diagnose", str(folder / "arms.yaml"), "--arm", name]
    for path in sorted(folder.glob("train_?.csv")):
        command += ["--train", str(path)]
    command += ["--test", str(folder / "test.csv"), "--out", str(folder / "diagnosis"), "--json"]
    command += ["--jobs", "1"]  # cases run side by side
    begin = time.perf_counter()
    environment = {**os.environ, **ONE_THREAD}
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    if done.returncode:
        raise CommandError(f"{' '.join(command[1:])}: exit {done.returncode}\n{done.stderr[-2000:]}")
    printed: dict[str, Any] = json.loads(done.stdout)
    written = json.loads((folder / "diagnosis" / "diagnosis.json").read_text(encoding="utf-8"))
    if printed != written:
        raise CommandError(f"{folder.name}: --json prints something else than diagnosis.json")
    return printed, time.perf_counter() - begin


def run(case: Case, folder: Path) -> tuple[Outcome, Label, float]:
    """Makes the case, lets it be diagnosed, opens the label. Outcome, label, seconds."""
    sealed = folder.with_suffix(".sealed")
    seal(make(case, folder), sealed)
    answer, seconds = diagnose(folder, case.name)
    label = unseal(sealed)
    free = case.arm in FREE
    measured = case.hidden and answer["causes"] and not free
    floor = reachable(case, folder, answer["settings"]["cutoff_hz"]) if measured else None
    return judge(answer, label, floor), label, seconds
