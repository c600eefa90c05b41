"""What each check of a cause is worth: answers counted again as if it decided otherwise.

    python -m blind.ablation DIR [DIR ...]

Without a check that decides, what it alone made a suspect is named; with one that is reported, what fails it
is none. Nothing is diagnosed again, so what the selection would have found next is not in it.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from blind.judge import answers, group, judged

Answered = tuple[dict[str, Any], dict[str, Any]]  # truth and answer of a case
HEADS = (
    "checks",
    "one effect: exact",
    "one effect: a false name",
    "nothing hidden or outside the catalogue: something named",
)


def ablated(cases: Sequence[Answered]) -> list[list[str]]:
    """Rows of a table under HEADS, that of the answers as they are first."""
    every = {
        c["name"]: c["decides"]
        for _, answer in cases
        for found in _found(answer.get("diagnosis") or {})
        for c in found.get("checks") or []
    }
    rows = [("as they are", cases)]
    rows += [(f"without `{name}`", _changed(cases, _without(name))) for name in every if every[name]]
    rows += [("without any", _changed(cases, lambda checks: set()))]
    rows += [(f"`{name}` decides too", _changed(cases, _with(name))) for name in every if not every[name]]
    return [[text, *_counts(changed)] for text, changed in rows]


def _found(diagnosis: dict[str, Any]) -> list[dict[str, Any]]:
    return [*(diagnosis.get("causes") or []), *(diagnosis.get("suspects") or [])]


def _without(name: str) -> Callable[[list[dict[str, Any]]], set[str]]:
    return lambda checks: _failed(checks) - {name}


def _with(name: str) -> Callable[[list[dict[str, Any]]], set[str]]:
    return lambda checks: (
        _failed(checks) | {c["name"] for c in checks if c["name"] == name and c["passed"] is False}
    )


def _failed(checks: list[dict[str, Any]]) -> set[str]:
    """Names of the checks that decide and are not passed."""
    return {c["name"] for c in checks if c["decides"] and c["passed"] is False}


def _changed(cases: Iterable[Answered], failed: Callable[[list[dict[str, Any]]], set[str]]) -> list[Answered]:
    """The cases where what fails these checks is a suspect, and the rest is named."""
    changed = []
    for said, answer in cases:
        diagnosis = answer.get("diagnosis")
        if diagnosis is not None:
            found = [(one, bool(failed(one.get("checks") or []))) for one in _found(diagnosis)]
            causes = [one for one, out in found if not out]
            suspects = [one for one, out in found if out]
            diagnosis = {**diagnosis, "causes": causes, "suspects": suspects}
        changed.append((said, answer if diagnosis is None else {**answer, "diagnosis": diagnosis}))
    return changed


def _counts(cases: Iterable[Answered]) -> list[str]:
    verdicts = [(group(said), judged(said, answer)) for said, answer in cases]
    hidden = [v for kind, v in verdicts if kind not in ("nothing", "outside")]
    others = [v for kind, v in verdicts if kind in ("nothing", "outside")]
    return [
        f"{sum(v.exact for v in hidden)} of {len(hidden)}",
        f"{sum(bool(v.false_names) for v in hidden)} of {len(hidden)}",
        f"{sum(bool(v.false_names) for v in others)} of {len(others)}",
    ]


def table(cases: Sequence[Answered]) -> str:
    """The rows in Markdown."""
    rows = [list(HEADS), ["---"] * len(HEADS), *ablated(cases)]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folders", type=Path, nargs="+")
    given = parser.parse_args()
    print(table([case for folder in given.folders for case in answers(folder)]))


if __name__ == "__main__":
    main()
