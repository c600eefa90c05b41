"""Cases made, and diagnosed by the command line, one folder each; what has an answer is not run again.

    python -m blind.runner DIR --family b --set working --kinds nothing one --sizes 1.10 --settings two

from benchmarks/, or with it on PYTHONPATH. `--part 2/5` takes every fifth case, from the second on:
several processes or machines share a set. `--seconds` ends after a time; the next call goes on.
`blind.judge DIR` counts.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from blind.case import TRUTH
from blind.cases import SIZES, Entry, chosen

ANSWER = "answer.json"
TOO_LONG = 1800  # s
Diagnose = Callable[[Path], dict[str, object]]


def command(folder: Path) -> list[str]:
    """Call of modelgen's diagnosis for a case that is written in `folder`."""
    said = json.loads((folder / TRUTH).read_text())
    line = [sys.executable, "-m", "modelgen", "diagnose", "arms.yaml", "--arm", said["arm"], "--out", "out"]
    for name in said["train"]:
        line += ["--train", f"{name}.csv"]
    line += ["--test", f"{said['test']}.csv", "--no-experiment", "--jobs", "1", "--json"]
    return [*line, "--mapping", "mapping.yaml"] if said["mapping"] else line


def diagnose(folder: Path) -> dict[str, object]:
    """Answer of modelgen: diagnosis.json, or the line by which it refuses; with its CPU time [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        ended = subprocess.run(
            command(folder),
            cwd=folder,
            capture_output=True,
            text=True,
            timeout=TOO_LONG,
            check=False,
            env=_one_thread(),
        )
    except subprocess.TimeoutExpired:
        return {"failed": f"no answer after {TOO_LONG} s"}
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    if ended.returncode == 0:
        return {"diagnosis": json.loads(ended.stdout), "cpu_s": round(spent, 2)}
    kind = "refused" if ended.returncode in (1, 2) and "Traceback" not in ended.stderr else "failed"
    return {kind: ended.stderr.strip()[-2000:] or ended.stdout.strip()[-2000:], "cpu_s": round(spent, 2)}


def _one_thread() -> dict[str, str]:
    return {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def run(
    entries: Sequence[Entry],
    into: Path,
    *,
    seconds: float | None = None,
    by: Diagnose = diagnose,
    keep: bool = False,
    retry: bool = False,
) -> int:
    """Answer the entries that have none in `into`, until `seconds` are over; how many are still without.

    by: what answers for a folder with a written case. keep: leave records and reports, which are large.
    retry: run again what failed, which is no answer of the diagnosis.
    """
    end = None if seconds is None else time.monotonic() + seconds
    left = [e for e in entries if wanted(into / e.name / ANSWER, retry)]
    for k, entry in enumerate(left):
        if end is not None and time.monotonic() > end:
            return len(left) - k
        folder = into / entry.name
        entry.make().write(folder)
        answer = by(folder)
        fresh = folder / (ANSWER + ".new")
        fresh.write_text(json.dumps(answer) + "\n")
        fresh.replace(folder / ANSWER)
        if not keep:
            _clear(folder)
        print(f"{k + 1}/{len(left)} {entry.name}: {told(answer)}", flush=True)
    return 0


def wanted(path: Path, retry: bool) -> bool:
    """Whether a case is to be run: it has no answer, or one that failed and is tried again."""
    return not path.exists() or (retry and "failed" in json.loads(path.read_text()))


def _clear(folder: Path) -> None:
    """Remove what can be made again: the records and what the diagnosis wrote beside its answer."""
    for path in sorted(folder.rglob("*"), reverse=True):
        if path.is_dir():
            path.rmdir()
        elif path.parent != folder or path.suffix == ".csv":
            path.unlink()


def told(answer: dict[str, object]) -> str:
    """An answer in one line."""
    for kind in ("refused", "failed"):
        if kind in answer:
            return f"{kind}: {str(answer[kind]).splitlines()[-1][:100]}"
    diagnosis = answer["diagnosis"]
    assert isinstance(diagnosis, dict)
    named = ", ".join(f"{c['effect']} {c['joint'] or ''}".strip() for c in diagnosis["causes"])
    return f"{diagnosis['verdict']} {named} ({answer.get('cpu_s')} s)"


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("into", type=Path)
    parser.add_argument("--family", default="b")
    parser.add_argument(
        "--set", default="working", help="'working', or the hash of a commit: the untouched set"
    )
    parser.add_argument("--count", type=int, default=1)
    parser.add_argument("--kinds", nargs="*", default=[])
    parser.add_argument("--sizes", nargs="*", type=float, default=list(SIZES))
    parser.add_argument("--settings", nargs="*", default=["four"])
    parser.add_argument("--part", default="1/1")
    parser.add_argument("--seconds", type=float)
    parser.add_argument("--keep", action="store_true", help="leave the records and the reports")
    parser.add_argument("--retry", action="store_true", help="run again what failed")
    parser.add_argument("--only-make", action="store_true", help="write the cases, diagnose nothing")
    given = parser.parse_args()
    part, parts = map(int, given.part.split("/"))
    entries = chosen(
        given.family,
        given.set,
        count=given.count,
        kinds=given.kinds,
        sizes=given.sizes,
        settings=given.settings,
    )[part - 1 :: parts]
    if given.only_make:
        for entry in entries:
            entry.make().write(given.into / entry.name)
        return
    left = run(entries, given.into, seconds=given.seconds, keep=given.keep, retry=given.retry)
    print(f"{len(entries) - left} of {len(entries)} have an answer")


if __name__ == "__main__":
    main()
