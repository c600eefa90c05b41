"""Answers of a folder counted against the truth: python -m blind.judge DIR [--json FILE] [--wrong].

One row for each group of cases (family, setting, group of kinds, size), with Wilson intervals of 95 %.
"""

from __future__ import annotations

import argparse
import json
import math
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from blind.case import FREE_PLAY, TRUTH
from blind.runner import ANSWER, told

Z = 1.959964  # of a normal distribution, two-sided 95 %


@dataclass(frozen=True)
class Verdict:
    """What an answer is worth.

    exact: names what is hidden, at its joint, and nothing else; where the catalogue has nothing of it,
    nothing.
    false_names: names of what is not there; where another cause of lost motion is named, `sibling` is
    set instead.
    missed: something of the catalogue is hidden and not named.
    removed: share of the error on the untouched record that the answer removes, over all joints [%], or
    None.
    """

    exact: bool
    false_names: tuple[str, ...]
    sibling: bool
    missed: bool
    suspects: int
    verdict: str
    removed: float | None
    cpu_s: float | None


def judged(said: dict[str, Any], answer: dict[str, Any]) -> Verdict:
    """Judge one answer. said: truth.json of the case; answer: what the runner wrote."""
    truth = said["truth"]
    hidden = truth["effect"] not in (None, "outside")
    spent = answer.get("cpu_s")
    if "diagnosis" not in answer:
        verdict = "refused" if "refused" in answer else "failed"
        return Verdict(False, (), False, hidden, 0, verdict, None, spent)
    found = answer["diagnosis"]
    right = [c for c in found["causes"] if hidden and _is(truth, c)]
    wrong = [c for c in found["causes"] if c not in right]
    siblings = [
        c for c in wrong if truth["effect"] in FREE_PLAY and c["effect"] in FREE_PLAY and _at(truth, c)
    ]
    false = tuple(f"{c['effect']} {c['joint'] or '-'}" for c in wrong if c not in siblings)
    exact = len(found["causes"]) == len(right) == int(hidden)
    suspects = len(found.get("suspects") or [])
    return Verdict(
        exact, false, bool(siblings), hidden and not right, suspects, found["verdict"], removed(found), spent
    )


def _at(truth: dict[str, Any], cause: dict[str, Any]) -> bool:
    return cause["joint"] in truth["joints"]


def _is(truth: dict[str, Any], cause: dict[str, Any]) -> bool:
    """Whether a cause is what is hidden, or an alias of it, which no record can tell from it."""
    if cause["effect"] == truth["effect"] and _at(truth, cause):
        return True
    return any(a.get("effect") == truth["effect"] and _at(truth, a) for a in cause.get("aliases") or [])


def removed(found: dict[str, Any]) -> float | None:
    """Share of the error on the untouched record that is removed [%]: of the joints' relative errors' RMS."""
    error = found.get("error") or {}
    pairs = [(b, a) for b, a in zip(error.get("before") or [], error.get("after") or [], strict=True) if b]
    if not pairs:
        return None
    return 100 * (1 - math.sqrt(sum((a / b) ** 2 for b, a in pairs) / len(pairs)))


def wilson(hits: int, of: int) -> tuple[float, float]:
    """Wilson's interval of a share, 95 %. (0, 1) of nothing."""
    if of == 0:
        return 0.0, 1.0
    p, z = hits / of, Z * Z / of
    middle, half = p + z / 2, Z * math.sqrt(p * (1 - p) / of + z / (4 * of))
    return max(0.0, (middle - half) / (1 + z)), min(1.0, (middle + half) / (1 + z))


def group(said: dict[str, Any]) -> str:
    """Group of kinds that a case counts in."""
    if said["kind"] == "nothing":
        return "nothing"
    if said["kind"].startswith("outside:"):
        return "outside"
    return "lost motion" if said["truth"]["effect"] in FREE_PLAY else "one effect"


def answers(folder: Path) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    """Truths and answers of a folder of cases, in the order of their names."""
    found = sorted(p.parent for p in folder.glob(f"*/{ANSWER}"))
    return [(json.loads((f / TRUTH).read_text()), json.loads((f / ANSWER).read_text())) for f in found]


def counted(cases: Iterable[tuple[dict[str, Any], dict[str, Any]]]) -> list[dict[str, Any]]:
    """A row for each group, and one for all."""
    groups: dict[tuple[str, ...], list[tuple[dict[str, Any], Verdict]]] = defaultdict(list)
    for said, answer in cases:
        one = (said, judged(said, answer))
        size = "" if said["size"] is None else f"{said['size']:.2f}"
        groups[said["family"], said["setting"], group(said), size].append(one)
        groups["~all", "", "", ""].append(one)
    return [_row(key, rows) for key, rows in sorted(groups.items())]


def _row(key: tuple[str, ...], rows: list[tuple[dict[str, Any], Verdict]]) -> dict[str, Any]:
    verdicts = [v for _, v in rows]
    n = len(verdicts)

    def share(hits: int) -> dict[str, Any]:
        return {"count": hits, "interval": [round(x, 4) for x in wilson(hits, n)]}

    gains = [v.removed for v in verdicts if v.removed is not None]
    spent = [v.cpu_s for v in verdicts if v.cpu_s is not None]
    return {
        "family": key[0].removeprefix("~"),
        "setting": key[1],
        "group": key[2],
        "size": key[3],
        "cases": n,
        "exact": share(sum(v.exact for v in verdicts)),
        "false": share(sum(bool(v.false_names) for v in verdicts)),
        "sibling": share(sum(v.sibling for v in verdicts)),
        "suspects": share(sum(v.suspects > 0 for v in verdicts)),
        **{
            k: share(sum(v.verdict == k for v in verdicts))
            for k in ("nothing_missing", "outside_catalogue", "cannot_tell", "refused", "failed")
        },
        "removed_percent": round(sum(gains) / len(gains), 2) if gains else None,
        "cpu_s": round(sum(spent) / len(spent), 1) if spent else None,
    }


COLUMNS = (
    "exact",
    "false",
    "sibling",
    "suspects",
    "nothing_missing",
    "outside_catalogue",
    "cannot_tell",
    "refused",
    "failed",
)
HEADS = ("exact", "false name", "sibling", "suspect", "nothing", "outside", "cannot", "refused", "failed")


def table(rows: list[dict[str, Any]]) -> str:
    """Rows as text: counts, and intervals [%] of the first two."""
    lines = [["family", "setting", "group", "s", "n", *HEADS, "removed %", "CPU s"]]
    for row in rows:
        cells = [str(row[k]) for k in ("family", "setting", "group", "size", "cases")]
        for k in COLUMNS:
            low, high = (100 * x for x in row[k]["interval"])
            wide = f" ({low:.0f} to {high:.0f} %)" if k in COLUMNS[:2] else ""
            cells.append(f"{row[k]['count']}{wide}")
        lines.append(
            [*cells, *("-" if row[k] is None else f"{row[k]}" for k in ("removed_percent", "cpu_s"))]
        )
    widths = [max(len(line[k]) for line in lines) for k in range(len(lines[0]))]
    return "\n".join(
        "  ".join(c.ljust(w) for c, w in zip(line, widths, strict=True)).rstrip() for line in lines
    )


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("--json", type=Path, help="write rows and cases there")
    parser.add_argument("--wrong", action="store_true", help="list what is not exact")
    given = parser.parse_args()
    cases = answers(given.folder)
    rows = counted(cases)
    print(table(rows))
    if given.wrong:
        for said, answer in cases:
            if not judged(said, answer).exact:
                truth = said["truth"]
                print(f"{said['kind']} {said['seed']} {said['setting']} {truth['joints']}: {told(answer)}")
    if given.json:
        single = [
            {k: said[k] for k in ("family", "setting", "kind", "size", "seed")} | asdict(judged(said, answer))
            for said, answer in cases
        ]
        given.json.write_text(json.dumps({"rows": rows, "cases": single}, indent=1) + "\n")


if __name__ == "__main__":
    main()
