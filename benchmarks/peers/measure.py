"""Running the harness: results, instructions, times."""

from __future__ import annotations

import re
import subprocess
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from peers.arms import Subject, model_text
from peers.build import run

Array = NDArray[np.float64]
_TOTAL = re.compile(r"^(?:totals|summary): (\d+)", re.MULTILINE)
_TRIGGER = re.compile(r"^desc: Trigger: Client Request: (\w+)", re.MULTILINE)


@dataclass(frozen=True)
class Call:
    """How to start a peer's harness for one arm."""

    program: Path
    folder: Path
    subject: Subject
    model: Path | None = None  # where it is not that of pinocchio_model.hpp

    def command(self, *mode: str) -> list[str]:
        """The command line; writes the files that it names."""
        model, states = self.folder / "model.txt", self.folder / "states.bin"
        if not states.exists():
            model.write_text(model_text(self.subject), encoding="utf-8")
            self.subject.states.tofile(states)
        samples = len(self.subject.states)
        return [
            str(self.program),
            str(self.model or model),
            str(states),
            str(self.subject.joints),
            str(samples),
            *mode,
        ]


def values(call: Call) -> dict[str, Array]:
    """Results of every function: samples x size."""
    found: dict[str, list[list[float]]] = defaultdict(list)
    name = ""
    for line in run(call.command("values")).splitlines():
        if re.match(r"[a-z_]+ \d+$", line):
            name = line.split()[0]
        else:
            found[name].append([float(x) for x in line.split()])
    return {name: np.array(rows) for name, rows in found.items()}


def instructions(call: Call) -> dict[str, float]:
    """Instructions per call of every function, mean over the states, what they call included."""
    for old in call.folder.glob("counts*"):
        old.unlink()
    out = call.folder / "counts"
    command = ["valgrind", "--tool=callgrind", "--collect-atstart=no", f"--callgrind-out-file={out}"]
    done = subprocess.run([*command, *call.command("count")], capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr[-2000:])
    result = {}
    for path in sorted(call.folder.glob("counts*")):
        text = path.read_text(encoding="utf-8", errors="replace")
        if named := _TRIGGER.search(text):
            total = _TOTAL.search(text)
            assert total is not None
            result[named[1]] = int(total[1]) / len(call.subject.states)
    return result


def nanoseconds(call: Call, seconds: float) -> dict[str, Array]:
    """CPU time per call [ns] of blocks of calls, the functions by turns."""
    found: dict[str, list[float]] = defaultdict(list)
    for line in run(call.command("time", str(seconds))).splitlines():
        name, value = line.split()
        found[name].append(float(value))
    return {name: np.array(times) for name, times in found.items()}


def heap(call: Call) -> float:
    """Bytes that the model and its functions have allocated once each function has run."""
    return float(run(call.command("heap")))
