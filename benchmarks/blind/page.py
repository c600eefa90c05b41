"""The page of the blind benchmark, docs/strangers.md, from kept answers.

    python -m blind.page --keep NAME "what the set is" DIR   # answers of a folder into runs/NAME.jsonl
    python -m blind.page                                     # the page anew, of all that is kept

What is kept of an answer is what the judge and the table of checks need.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from blind.ablation import Answered
from blind.ablation import table as checks_table
from blind.judge import answers, counted
from blind.others.method import method
from blind.others.table import Score, picture, scores
from blind.others.table import table as others_table

HERE = Path(__file__).resolve().parent
RUNS = HERE / "runs"
PAGE = HERE.parents[1] / "docs" / "strangers.md"
PICTURE = PAGE.with_suffix(".svg")

INTRODUCTION = """\
# Strangers' arms: measured

*How often does `modelgen diagnose` name what is there, and what is not, on arms and records that it was not
made for?*

Of each kind of records the newest set of three cases or more that nothing was chosen on:
"""
MEANING = """\
Exact is the right name at the right joint and nothing else; where nothing that the catalogue knows is
hidden, it is nothing named. Answers that name nothing there are "I cannot tell", "something outside the
catalogue", or a suspect with the check that it failed. In brackets: 95 % Wilson intervals.

- **Arms.** Family B is made by Lagrange's equations in C with joint loops, sticking friction, inductances and
  logs that read their channels late, family C is random arms simulated by MuJoCo. They share no code with
  modelgen, nor with each other.
- **Records.** `two` is two records of 30 s at 100 Hz, `four` four at 500 Hz, `ordinary` is pick and place,
  jogging and sweeps, in which nothing repeats.
- **Size.** s is the error of a fit of the user's model over that of the same fit without the hidden thing: at
  1.10 the hidden thing has a fifth of the noise's power, at 1.30 two thirds.

## What is still wrong

Lost motion is rarely named at these sizes: play and elastic joints are suspects, or "I cannot tell". A thing
outside the catalogue that acts nearly as a law inside it does on these records has that law's name: where
nothing repeats, and what is left is as large as the noise, no record can tell the two. Causes are held
against functions of another joint's motion and of what was before for this reason; of the six false names in
15 ordinary records of `b-5ebf2491` below, and of the five of `b-80585599`, which this was made on, two and
three are left.
"""
MEASURED = """\
## How it was measured

The cases are those of `benchmarks/blind`, and every answer is kept in `benchmarks/blind/runs`. Each set was
answered by the code of its commit and looked at once; what was found in it was mended later, so that it is no
proof of the mended code. The newest set comes last.
"""
OTHERS = """\
## What others name

The same records, and other ways to choose. All get the same filtered equations, those of the band that
modelgen asks first, and the same columns: every candidate of [the catalogue](effects.md) at every place, with
the values at which it explains most alone beside the user's model. modelgen's search finds these, so that the
others need none. What is compared is the choice, not the filtering. The parameters of the user's model are
fitted beside whatever is chosen. None of the others has modelgen's checks. The judge is the same, and
aliases count for all.

![Exact names, false names and error removed, by method](strangers.svg)

Error removed is on the test record, which no method has seen: of the mean square error that the hidden
effect adds to the noise, at its joint, the part that the extended model removes; all cases together, with
an interval of 95 % by a bootstrap of the cases. Who names nothing removes nothing. A near relative of what is
hidden, or several of them together, can predict as well as the right name: an error removed is no proof of
a name. The network names nothing; it learns what the user's model leaves.
"""
ADDING = """\
A method of your own is a class of a few lines in a module of `benchmarks/blind/others/methods`; it is found
by the module's name. `benchmarks/blind/README.md` shows one. From `benchmarks`,

```sh
pip install -e "..[others]"
python -m blind.others.runner mine --seconds 600   # goes on where it ended
python -m blind.page                               # this page with its row
```
"""
CHECKS = """\
## What each check is worth

The same answers, counted again as if a check decided otherwise: without one that decides, what it alone
made a suspect is named. The checks are described in [how a diagnosis works](diagnosis_method.md).
"""
FEW = 3  # cases, from which a set is shown among the answers
ANSWER = ("family", "records", "hidden", "s", "cases", "exact", "a false name", "set")
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


@dataclass(frozen=True)
class Kept:
    """A kept set. text: what it is; number: by age, the newest has the largest; cases: truths and answers."""

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
    texts = "\n".join(f"- `{name}`: {one.text}" for name, one in sets().items())
    every = every_case()
    checks = [CHECKS, checks_table(every), ""]
    measured = [MEASURED, texts, "", _table(COLUMNS, _all_rows()), ""]
    parts = [INTRODUCTION, _table(ANSWER, _answer_rows()), "", MEANING, *_others(every), *checks, *measured]
    return "\n".join(parts)


def _table(heading: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    return "\n".join(f"| {' | '.join(row)} |" for row in [heading, ("---",) * len(heading), *rows])


def _all_rows() -> list[tuple[str, ...]]:
    """Counts of every set, family and kind of records."""
    return [
        _row(name, row)
        for name, one in sets().items()
        for row in counted(one.cases)
        if row["family"] != "all"
    ]


def _answer_rows() -> list[tuple[str, ...]]:
    """Of every family, kind of records, what is hidden and its size the counts of the newest set that has
    FEW cases of it; a set to work on is none.
    """
    newest: dict[tuple[str, ...], tuple[str, ...]] = {}
    for name, one in sets().items():
        if not one.number:
            continue
        for row in counted(one.cases):
            if row["family"] != "all" and row["cases"] >= FEW:
                place = (row["family"].upper(), row["setting"], row["group"], row["size"] or "-")
                newest[place] = (*place, *_row(name, row)[4:7], f"`{name}`")
    order = {group: k for k, group in enumerate(("nothing", "one effect", "lost motion", "outside"))}
    return sorted(newest.values(), key=lambda row: (row[0], row[1], order[row[2]], row[3]))


def every_case() -> list[Answered]:
    """Truths and answers of all kept sets."""
    return [case for path in sorted(RUNS.glob("*.jsonl")) for case in kept(path.stem).cases]


def _others(every: list[Answered]) -> list[str]:
    """What other methods do on the same cases; empty where none has an answer."""
    rows = compared(every)
    if not rows:
        return []
    tuned = [f"- {by.title}: {by.tuning}" for by in (method(row.name) for row in rows[1:])]
    count = (
        f"Counted on {rows[0].false[1]} of the {len(every)} cases: those that all have answered, and in "
        "which the user's model leaves the same error in the band of either.\n"
    )
    return [OTHERS, count, others_table(rows), "", *tuned, "", ADDING]


def compared(every: Sequence[Answered]) -> list[Score]:
    """Scores of modelgen, from its kept answers, and of the other methods, on the cases of all."""
    return scores([{"truth": said, "answer": answer} for said, answer in every])


def _row(name: str, row: dict[str, Any]) -> tuple[str, ...]:
    def share(key: str) -> str:
        low, high = (100.0 * x for x in row[key]["interval"])
        return f"{row[key]['count']} ({low:.0f} to {high:.0f} %)"

    more = ("-" if row[k] is None else f"{row[k]:.1f}" for k in ("removed_percent", "cpu_s"))
    place = (name, row["setting"], row["group"], row["size"] or "-", str(row["cases"]))
    return (*place, share("exact"), share("false"), str(row["suspects"]["count"]), *more)


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--keep", nargs=3, metavar=("NAME", "TEXT", "DIR"))
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
