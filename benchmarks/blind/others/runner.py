"""Methods run on the cases of which modelgen's answers are kept; what has an answer is not run again.

    python -m blind.others.runner [METHOD ...] [--seconds 600] [--part 1/2] [--retry]

from benchmarks/, or with it on PYTHONPATH. Answers go into runs/others/METHOD.jsonl; `blind.page` makes table
and picture of them. Methods need the packages of the extra `others`.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from zlib import crc32

from blind.case import Case
from blind.cases import Entry
from blind.others.answers import OTHERS, Line, entry_of, keep, lines, truth_of
from blind.others.method import Method, known, method
from blind.others.problem import answered, asked
from blind.page import RUNS, kept
from modelgen.errors import InputError


def entries() -> list[Entry]:
    """Cases that are kept, in an order by lot, the same each time: the first of them are a sample of all."""
    found = [entry_of(said) for path in sorted(RUNS.glob("*.jsonl")) for said, _ in kept(path.stem).cases]
    return sorted(dict.fromkeys(found), key=lambda e: (crc32(e.name.encode()), e.name))


def answers_of(case: Case, methods: Sequence[Method]) -> list[Line]:
    """Answers of the methods for a case. What a method raises is a failure of it; where the records cannot
    answer, all are refused.
    """
    with tempfile.TemporaryDirectory() as folder:
        try:
            ask = asked(case, Path(folder))
        except InputError as refused:
            return [{"refused": str(refused)} for _ in methods]
        found: list[Line] = []
        for by in methods:
            try:
                found.append(answered(ask, by))
            except Exception as failed:  # whatever another's code may raise
                found.append({"failed": f"{type(failed).__name__}: {failed}"[:2000]})
        return found


def run(
    cases: Sequence[Entry],
    methods: Mapping[str, Method],
    *,
    seconds: float | None = None,
    retry: bool = False,
    folder: Path = OTHERS,
) -> int:
    """Answer the cases that a method has no answer for, until `seconds` are over; how many are still without.

    retry: run again what failed.
    """
    end = None if seconds is None else time.monotonic() + seconds
    missing = {e: _missing(e, methods, retry, folder) for e in cases}
    left = [e for e in cases if missing[e]]
    for number, entry in enumerate(left):
        if end is not None and time.monotonic() > end:
            return len(left) - number
        case = entry.make()
        found = answers_of(case, [methods[name] for name in missing[entry]])
        for name, answer in zip(missing[entry], found, strict=True):
            line = {"truth": truth_of(case), "answer": answer}
            keep(name, {**lines(name, folder), entry: line}, folder)
        print(f"{number + 1}/{len(left)} {entry.name}: {_short(missing[entry], found)}", flush=True)
    return 0


def _missing(entry: Entry, methods: Mapping[str, Method], retry: bool, folder: Path) -> list[str]:
    found = {name: lines(name, folder).get(entry) for name in methods}
    return [name for name, line in found.items() if line is None or (retry and "failed" in line["answer"])]


def _short(names: Sequence[str], found: Sequence[Line]) -> str:
    """How many each names, or how it ended."""
    parts = []
    for name, answer in zip(names, found, strict=True):
        ended = next((k for k in ("refused", "failed") if k in answer), "")
        parts.append(f"{name} {ended or len(answer['diagnosis']['causes'])}")
    return ", ".join(parts)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("methods", nargs="*", help=f"of {', '.join(known())}; all by default")
    parser.add_argument("--seconds", type=float, help="end after so many")
    parser.add_argument("--part", default="1/1", help="of the cases: 2/3 is every third, from the second on")
    parser.add_argument("--retry", action="store_true", help="run again what failed")
    parser.add_argument("--folder", type=Path, default=OTHERS, help="of the answers")
    given = parser.parse_args()
    part, parts = map(int, given.part.split("/"))
    cases = entries()[part - 1 :: parts]
    methods = {name: method(name) for name in given.methods or known()}
    left = run(cases, methods, seconds=given.seconds, retry=given.retry, folder=given.folder)
    print(f"{len(cases) - left} of {len(cases)} cases have an answer of each method")


if __name__ == "__main__":
    main()
