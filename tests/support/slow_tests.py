"""The tests that `make check` leaves out: the names in tests/slow.txt, written from the times of a run.

pytest --durations=0 > durations.txt; python tests/support/slow_tests.py durations.txt [another ...]
"""

from __future__ import annotations

import re
import sys
from collections.abc import Collection, Iterable
from pathlib import Path

LIST = Path(__file__).resolve().parents[1] / "slow.txt"
# Seconds of processor time of set-up, call and tear-down together.
LIMIT = 0.15

_TIME = re.compile(r"([\d.]+)s (?:setup|call|teardown) +(\S+\.py::.*)")
_FUNCTION = re.compile(r"^def (\w+)\(", re.MULTILINE)


def function_of(node: str) -> str:
    """File and function of a test's id, without the case and the group of pytest-xdist."""
    return re.sub(r"@\w+$", "", node.split("[", maxsplit=1)[0])


def listed() -> frozenset[str]:
    """Files and functions of the list, as in the ids of pytest."""
    return frozenset(LIST.read_text(encoding="utf-8").split())


def slow(runs: Iterable[str], limit: float = LIMIT) -> list[str]:
    """The functions with a case that took more than `limit` seconds in one of the files of times."""
    found = set()
    for run in runs:
        total: dict[str, float] = {}
        for line in run.splitlines():
            if match := _TIME.fullmatch(line.rstrip()):
                total[match[2]] = total.get(match[2], 0.0) + float(match[1])
        found |= {function_of(node) for node, seconds in total.items() if seconds > limit}
    return sorted(found)


def without_a_test(names: Collection[str], folder: Path) -> list[str]:
    """Those of the names that no function of a file in the folder has."""
    there: set[str] = set()
    for file in sorted({name.partition("::")[0] for name in names}):
        path = folder / file
        text = path.read_text(encoding="utf-8") if path.is_file() else ""
        there |= {f"{file}::{function}" for function in _FUNCTION.findall(text)}
    return sorted(set(names) - there)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit("usage: python tests/support/slow_tests.py <file of pytest --processor-times> ...")
    names = slow(Path(path).read_text(encoding="utf-8") for path in sys.argv[1:])
    LIST.write_text("".join(f"{name}\n" for name in names), encoding="utf-8")
    sys.stdout.write(f"{len(names)} functions above {LIMIT} s in {LIST.name}\n")
