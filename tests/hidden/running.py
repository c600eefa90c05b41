"""One case from its drawing to its verdict: modelgen sees the logs, then the label is opened."""

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
from modelgen.description import load
from modelgen.diagnosis import pipeline
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.diagnosis.pipeline import records
from modelgen.diagnosis.result import to_json
from modelgen.effects import known_effects
from modelgen.jobs import Where

ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


class CommandError(RuntimeError):
    """modelgen diagnose did not do its work."""


def trained(folder: Path) -> list[str]:
    """The training records of a case."""
    return [str(path) for path in sorted(folder.glob("train_?.csv"))]


def diagnosed_here(folder: Path, name: str, *, experiment: bool = False) -> dict[str, Any]:
    """The answer to the logs in the folder, as diagnosis.json holds it, without report, code and process.

    experiment: with the one that would tell apart what these records do not.
    """
    arm = load(folder / "arms.yaml", known_effects())[name]
    logs = records(arm, trained(folder), [str(folder / "test.csv")], None, USUAL.dataset)
    found = pipeline.diagnose(arm, logs, where=Where(1), experiment=experiment)
    answer: dict[str, Any] = json.loads(json.dumps(to_json(found), allow_nan=False))
    return answer


def diagnose(folder: Path, name: str) -> tuple[dict[str, Any], float]:
    """The answer of the command line on the logs in the folder, and the seconds it took."""
    command = [sys.executable, "-m", "modelgen", "diagnose", str(folder / "arms.yaml"), "--arm", name]
    for path in trained(folder):
        command += ["--train", path]
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
    """Makes the case, lets the command line diagnose it, opens the label. Outcome, label, seconds."""
    sealed = folder.with_suffix(".sealed")
    seal(make(case, folder), sealed)
    answer, seconds = diagnose(folder, case.name)
    found, label = judged(case, folder, answer)
    return found, label, seconds


def run_here(case: Case, folder: Path) -> tuple[Outcome, dict[str, Any]]:
    """Makes the case, diagnoses it in this process, opens the label. Outcome and answer."""
    seal(make(case, folder), folder.with_suffix(".sealed"))
    answer = diagnosed_here(folder, case.name)
    return judged(case, folder, answer)[0], answer


def judged(case: Case, folder: Path, answer: dict[str, Any]) -> tuple[Outcome, Label]:
    """What an answer to a case that was made and sealed is worth, and the label."""
    sealed = folder.with_suffix(".sealed")
    label = unseal(sealed)
    free = case.arm in FREE
    measured = case.hidden and answer["causes"] and not free
    floor = reachable(case, folder, answer["settings"]["cutoff_hz"]) if measured else None
    return judge(answer, label, floor), label
