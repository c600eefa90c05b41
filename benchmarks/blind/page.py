"""The page of the blind benchmark, docs/strangers.md, from kept answers.

    python -m blind.page --keep NAME "what is special of it" DIR   # answers of a folder into runs/NAME.jsonl
    python -m blind.page                                           # the page anew, of all that is kept

What is kept of an answer is what the judge and the table of checks need.
"""

from __future__ import annotations

import argparse
import json
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from blind import page_words as words
from blind.ablation import Answered
from blind.ablation import table as checks_table
from blind.judge import answers, counted, group
from blind.others.method import method
from blind.others.table import Score, picture, scores
from blind.others.table import table as others_table

HERE = Path(__file__).resolve().parent
RUNS = HERE / "runs"
PAGE = HERE.parents[1] / "docs" / "strangers.md"
PICTURE = PAGE.with_suffix(".svg")

FEW = 3  # cases, from which a set is shown among the answers
SIZE, SMALL = "1.30", "1.10"  # sizes s of what is said in words
ORDER = ("nothing", "one effect", "lost motion", "outside")
ANSWER = ("hidden", "s", "exact", "a false name")
BY_RECORDS = ("family", "records", "hidden", "s", "arms", "exact", "a false name", "set")
COLUMNS = (
    "set",
    "records",
    "hidden",
    "s",
    "cases",
    "exact",
    "a false name",
    "suspects",
    "error removed %",
    "CPU s",
)

Place = tuple[str, str, str, str]  # family, setting, group of kinds, size
Shown = Mapping[Place, tuple[str, list[Answered]]]


@dataclass(frozen=True)
class Kept:
    """A kept set. text: what is special of it, if anything; number: by age, the newest has the largest;
    cases: truths and answers.
    """

    text: str
    number: int
    cases: list[Answered]


def kept(name: str) -> Kept:
    """Read a kept set."""
    first, *lines = (RUNS / f"{name}.jsonl").read_text(encoding="utf-8").splitlines()
    said = json.loads(first)
    return Kept(said["text"], said["number"], [(x["truth"], x["answer"]) for x in map(json.loads, lines)])


def sets() -> dict[str, Kept]:
    """Every kept set by its name, the oldest first."""
    found = {path.stem: kept(path.stem) for path in RUNS.glob("*.jsonl")}
    return dict(sorted(found.items(), key=lambda item: (item[1].number, item[0])))


def keep(name: str, text: str, folder: Path) -> None:
    """Write what is needed of the answers of a folder, as the newest set, or in place of that of its name."""
    before = sets()
    last = max((one.number for one in before.values()), default=0)
    number = before[name].number if name in before else last + 1
    lines = [json.dumps({"text": text, "number": number})]
    lines += [
        json.dumps({"truth": _truth(said), "answer": _answer(found)}) for said, found in answers(folder)
    ]
    RUNS.mkdir(exist_ok=True)
    (RUNS / f"{name}.jsonl").write_text("\n".join(lines) + "\n", encoding="utf-8")


def _truth(said: dict[str, Any]) -> dict[str, Any]:
    own = {k: said["truth"][k] for k in ("effect", "joints")}
    return {"truth": own, **{k: said[k] for k in ("family", "seed", "kind", "size", "setting")}}


def _answer(answer: dict[str, Any]) -> dict[str, Any]:
    if "diagnosis" not in answer:
        return answer
    found = answer["diagnosis"]
    short = {
        "verdict": found["verdict"],
        "error": {k: (found.get("error") or {}).get(k) for k in ("before", "after")},
        **{k: [_cause(c) for c in found.get(k) or []] for k in ("causes", "suspects")},
    }
    return {"diagnosis": short, "cpu_s": answer.get("cpu_s")}


def _cause(c: dict[str, Any]) -> dict[str, Any]:
    checks = [{k: check[k] for k in ("name", "passed", "decides")} for check in c.get("checks") or []]
    return {"effect": c["effect"], "joint": c["joint"], "aliases": c.get("aliases") or [], "checks": checks}


def page() -> str:
    """The page, of all that is kept."""
    every, shown = every_case(), newest()
    said = figures(shown)
    texts = [f"- `{name}`: {one.text}" for name, one in sets().items() if one.text]
    parts = [
        words.INTRODUCTION.format(**said),
        _table(ANSWER, _pooled(shown)),
        "",
        _folded(words.BY_RECORDS, _table(BY_RECORDS, _by_records(shown))),
        words.CANNOT.format(**said),
        *_others(every),
        words.CHECKS,
        checks_table(every),
        "",
        words.SETS.format(few=FEW),
        *texts,
        "",
        _folded(words.EVERY_SET, _table(COLUMNS, _all_rows())),
        words.RUNNING,
    ]
    return "\n".join(parts).rstrip("\n") + "\n"


def _table(heading: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    return "\n".join(f"| {' | '.join(row)} |" for row in [heading, ("---",) * len(heading), *rows])


def _folded(title: str, table: str) -> str:
    """A table that opens by a click, in Markdown."""
    return f"<details>\n<summary>{title}</summary>\n\n{table}\n\n</details>\n"


def _all_rows() -> list[tuple[str, ...]]:
    """Counts of every set, family and kind of records."""
    return [
        _row(name, row)
        for name, one in sets().items()
        for row in counted(one.cases)
        if row["family"] != "all"
    ]


def newest() -> dict[Place, tuple[str, list[Answered]]]:
    """Of every family, kind of records, what is hidden and its size the newest set that has FEW cases of it,
    and these; a set to work on is none.
    """
    found: dict[Place, tuple[str, list[Answered]]] = {}
    for name, one in sets().items():
        places: dict[Place, list[Answered]] = defaultdict(list)
        for said, answer in one.cases if one.number else ():
            size = "" if said["size"] is None else f"{said['size']:.2f}"
            places[said["family"], said["setting"], group(said), size].append((said, answer))
        found |= {place: (name, cases) for place, cases in places.items() if len(cases) >= FEW}
    return found


def _by_records(shown: Shown) -> list[tuple[str, ...]]:
    """Counts by family and kind of records, each of one set."""
    places = sorted(shown, key=lambda p: (*p[:2], ORDER.index(p[2]), p[3]))
    rows = [(place, *shown[place]) for place in places]
    return [(p[0].upper(), p[1], *_counts(p[2:], _together(cases)), f"`{name}`") for p, name, cases in rows]


def _pooled(shown: Shown) -> list[tuple[str, ...]]:
    """Counts by what is hidden and its size, all families and kinds of records together."""
    kinds = sorted({place[2:] for place in shown}, key=lambda kind: (ORDER.index(kind[0]), kind[1]))
    rows = [(*kind, _together(_cases(shown, *kind))) for kind in kinds]
    return [(hidden, size or "-", _of(row, "exact"), _of(row, "false")) for hidden, size, row in rows]


def _cases(shown: Shown, hidden: str, size: str) -> list[Answered]:
    return [case for place, (_, cases) in shown.items() if place[2:] == (hidden, size) for case in cases]


def _together(cases: Iterable[Answered]) -> dict[str, Any]:
    """Counts of cases of any kind, in one row of `blind.judge`."""
    (row,) = (row for row in counted(cases) if row["family"] == "all")
    return row


def _counts(kind: Sequence[str], row: dict[str, Any]) -> tuple[str, ...]:
    return kind[0], kind[1] or "-", str(row["cases"]), _share(row, "exact"), _share(row, "false")


def figures(shown: Shown) -> dict[str, str]:
    """What the page says in words: counts with their intervals."""

    def said(key: str, hidden: str, size: str = SIZE) -> str:
        return _of(_together(_cases(shown, hidden, size)), key, " arms")

    return {
        "s": SIZE,
        "small": SMALL,
        "alarms": said("false", "nothing", ""),
        "named": said("exact", "one effect"),
        "misnamed": said("false", "one effect"),
        "outside": said("false", "outside"),
        "lost": said("exact", "lost motion"),
        "siblings": str(_together(_cases(shown, "lost motion", SIZE))["sibling"]["count"]),
        "named_small": said("exact", "one effect", SMALL),
        "misnamed_small": said("false", "one effect", SMALL),
    }


def every_case() -> list[Answered]:
    """Truths and answers of all kept sets."""
    return [case for path in sorted(RUNS.glob("*.jsonl")) for case in kept(path.stem).cases]


def _others(every: list[Answered]) -> list[str]:
    """What other methods do on the same cases; empty where none has an answer."""
    rows = compared(every)
    if not rows:
        return []
    tuned = [f"- {by.title}: {by.tuning}" for by in (method(row.name) for row in rows[1:])]
    count = words.COUNTED.format(common=rows[0].false[1], every=len(every))
    return [words.OTHERS, count, others_table(rows), "", *tuned, ""]


def compared(every: Sequence[Answered]) -> list[Score]:
    """Scores of modelgen, from its kept answers, and of the other methods, on the cases of all."""
    return scores([{"truth": said, "answer": answer} for said, answer in every])


def _row(name: str, row: dict[str, Any]) -> tuple[str, ...]:
    more = ("-" if row[k] is None else f"{row[k]:.1f}" for k in ("removed_percent", "cpu_s"))
    place = (name, row["setting"], row["group"], row["size"] or "-", str(row["cases"]))
    return (*place, _share(row, "exact"), _share(row, "false"), str(row["suspects"]["count"]), *more)


def _of(row: dict[str, Any], key: str, what: str = "") -> str:
    """A count out of the cases of a row. what: they are."""
    return _share(row, key).replace(" (", f" of {row['cases']}{what} (")


def _share(row: dict[str, Any], key: str) -> str:
    low, high = (100.0 * x for x in row[key]["interval"])
    return f"{row[key]['count']} ({low:.0f} to {high:.0f} %)"


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--keep", nargs=3, metavar=("NAME", "SPECIAL", "DIR"))
    given = parser.parse_args()
    if given.keep:
        name, text, folder = given.keep
        keep(name, text, Path(folder))
    PAGE.write_text(page(), encoding="utf-8")
    rows = compared(every_case())
    if rows:
        PICTURE.write_text(picture(rows), encoding="utf-8")


if __name__ == "__main__":
    main()
