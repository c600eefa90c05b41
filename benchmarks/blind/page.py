"""The page of the blind benchmark, docs/strangers.md, from kept answers.

    python -m blind.page --keep NAME "what the set is" DIR   # answers of a folder into runs/NAME.jsonl
    python -m blind.page                                     # the page anew, of all that is kept

What is kept of an answer is what the judge and the table of checks need.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
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

How often does `modelgen diagnose` name what is there, and what is not, on arms and records that it was not
made for? The plants are those of the blind benchmark (`benchmarks/blind`): family B by Lagrange's equations
in C with joint loops, sticking friction, inductances and logs that read their channels late, family C
random arms simulated by MuJoCo. They share no code with modelgen, nor with each other. s is the error of a
fit of the user's model over that of the same fit without the hidden thing: at 1.10 the hidden thing has a
fifth of the noise's power, at 1.30 two thirds. `two` is two records of 30 s at 100 Hz, `four` four at 500
Hz, `ordinary` is pick and place, jogging and sweeps, in which nothing repeats. In brackets: 95 % Wilson
intervals. Every answer is kept in `benchmarks/blind/runs`.

Exact is the right name at the right joint and nothing else; where nothing that the catalogue knows is
hidden, it is nothing named. Answers that name nothing there are "I cannot tell", "something outside the
catalogue", or a suspect with the check that it failed.
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


def kept(name: str) -> tuple[str, list[Answered]]:
    """What a kept set is, and its cases."""
    first, *lines = (RUNS / f"{name}.jsonl").read_text(encoding="utf-8").splitlines()
    return json.loads(first)["text"], [(x["truth"], x["answer"]) for x in map(json.loads, lines)]


def keep(name: str, text: str, folder: Path) -> None:
    """Write what is needed of the answers of a folder."""
    lines = [json.dumps({"text": text})]
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
    sets = {path.stem: kept(path.stem) for path in sorted(RUNS.glob("*.jsonl"))}
    rows = [COLUMNS, ("---",) * len(COLUMNS)]
    for name, (_, cases) in sets.items():
        rows += [_row(name, row) for row in counted(cases) if row["family"] != "all"]
    table = "\n".join(f"| {' | '.join(row)} |" for row in rows)
    texts = "\n".join(f"- `{name}`: {text}" for name, (text, _) in sets.items())
    every = every_case()
    parts = [INTRODUCTION, texts, "", table, "", *_others(every), CHECKS, checks_table(every), ""]
    return "\n".join(parts)


def every_case() -> list[Answered]:
    """Truths and answers of all kept sets."""
    return [case for path in sorted(RUNS.glob("*.jsonl")) for case in kept(path.stem)[1]]


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
