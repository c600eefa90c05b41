"""What generating and running costs besides time: memory, bytes."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from time import process_time

from peers.build import HERE, run

# A process of its own without anything in it: the memory of whoever starts a program counts as the program's
# until it runs, so that a large Python would hide it.
_LAUNCHER = """\
import json, resource, subprocess, sys
done = subprocess.run(sys.argv[1:], stdout=subprocess.PIPE)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
spent = used.ru_utime + used.ru_stime
print(json.dumps([spent, used.ru_maxrss / 1024, done.stdout.decode(), done.returncode]))
"""
_PEAK = re.compile(r"VmHWM:\s+(\d+) kB")
_SECTION = re.compile(r"^(\.(?:text|rodata|data|bss)\S*)\s+(\d+)", re.MULTILINE)


class Stopped(RuntimeError):
    """A command failed after `seconds` of CPU time."""

    def __init__(self, message: str, seconds: float) -> None:
        super().__init__(message)
        self.seconds = seconds


def peak() -> float:
    """The most memory that this process has held so far [MB]."""
    found = _PEAK.search(Path("/proc/self/status").read_text(encoding="utf-8"))
    assert found is not None
    return int(found[1]) / 1024


def generation(make: Callable[[], object]) -> None:
    """Call it, and print its CPU time [s] and the memory [MB] held before it, for `generated`."""
    before, start = peak(), process_time()
    make()
    print(json.dumps([process_time() - start, before]))


def launched(command: Sequence[str]) -> tuple[float, float, str]:
    """CPU time [s], most memory [MB] and standard output of a command. Raises Stopped where it fails."""
    threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
    # The modelgen of this process, whatever folder the command runs in.
    path = os.pathsep.join(str(Path(folder).resolve()) for folder in sys.path if folder)
    done = subprocess.run(
        [sys.executable, "-S", "-E", "-c", _LAUNCHER, *command],
        capture_output=True,
        text=True,
        check=False,
        cwd=HERE.parent,  # where `-m` finds this package
        env=os.environ | threads | {"PYTHONPATH": path},
    )
    if done.returncode:
        raise RuntimeError(done.stderr[-3000:])
    seconds, memory, said, status = json.loads(done.stdout)
    if status:
        raise Stopped(f"{' '.join(command)}\n{done.stderr[-3000:]}", seconds)
    return seconds, memory, said


def limited(command: Sequence[str], seconds: int) -> tuple[float, float] | None:
    """CPU time [s] and most memory [MB] of a command, None where it takes longer than `seconds` of CPU time.

    Raises RuntimeError where it fails of itself. A shell or a compiler reports a killed child as a failure.
    """
    try:
        spent, memory, _ = launched(["sh", "-c", f'ulimit -t {seconds}; "$@"', "sh", *command])
    except Stopped as stopped:
        if stopped.seconds < 0.95 * seconds and "Killed" not in str(stopped):
            raise
        return None
    return spent, memory


def generated(module: str, *arguments: str) -> dict[str, float]:
    """Costs of a module of this package that ends in `generation`: CPU time [s] after its imports, the most
    memory [MB], and what of it the imports had taken."""
    _, memory, said = launched([sys.executable, "-m", module, *arguments])
    seconds, before = json.loads(said.splitlines()[-1])
    return {"seconds": seconds, "memory": memory, "imports": before}


def sections(path: Path) -> dict[str, int]:
    """Bytes of an object file: code, and constants and static variables."""
    found = {"code": 0, "tables": 0}
    for name, size in _SECTION.findall(run(["size", "-A", str(path)])):
        found["code" if name.startswith(".text") else "tables"] += int(size)
    return found


def stack(objects: Sequence[Path]) -> int:
    """The largest frame [bytes] of the functions in objects that were compiled with -fstack-usage."""
    texts = [path.with_suffix(".su").read_text(encoding="utf-8") for path in objects]
    return max(int(line.split("\t")[1]) for text in texts for line in text.splitlines())
