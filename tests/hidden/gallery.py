"""make gallery: every effect of the catalogue as a person meets it, docs/gallery.md and its pictures.

    PYTHONPATH=tests python -m hidden.gallery [--only NAMES]

What the records of each effect show is kept in runs/gallery.jsonl, from which the page is written.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from hidden.lookalikes import Found, found
from hidden.tallies import RUNS, Line, measured
from modelgen.charts import Chart, number, sheet
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.effects import CATALOGUE, Definition
from modelgen.jobs import one_thread
from modelgen.report.in_a_log import LEAST, in_records, seen_by
from modelgen.report.law_figures import judged_joint, law_charts, law_size
from modelgen.report.words import finding, law, listed, sentence

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
KEPT = RUNS / "gallery.jsonl"
SIZE = (350, 210)  # pixel: two beside each other on a page of the documentation, one on a telephone
GROUPS = ("single", "coarse", "link_side")  # of a blind run, with one effect of the catalogue hidden
ENOUGH = USUAL.selection.rival_margin_bic  # of a test that separates two causes
HEAD = """\
# Gallery of effects

*What does each effect of the [catalogue](effects.md) do to a log, what looks like it, and how do I tell
the two apart?* Every entry has a law, what simulated records show of it, and what separates it from its
[look-alikes](glossary.md); [below](#how-these-records-were-made): which arms, and what is counted.
"""
MADE = """\
## How these records were made

The records are of simulated arms: `direct2` has two joints with geared motors, `levered2` two that screws
turn by levers, `mixed2` one of each, `mixed3` a slewing joint with a geared motor and two with screws and
levers. The plant shares no code with modelgen.

The first picture of an entry is the law with the values of an example. The other two are
of simulated records in which the effect was hidden, over what shows it best: what the rest of the model
leaves of the effort, with the law that `modelgen diagnose --effect` finds; and the mean residual without
and with it. What remembers, or has to do with other joints, is drawn over those seconds of the test record
in which it explains most.

The evidence of a look-alike is what it explains of the same records in place of the effect that is there: one
near 100 % cannot be separated from it by them. Of the tests on the bench, the one is named of which `modelgen
diagnose` expects most evidence (delta BIC), in the noise of these records; where none has enough of it, the
experiment that shows the look-alike.

How often [the blind run](diagnosis.md) found an effect is counted over all its arms in which that effect
alone was hidden: those with fine encoders at three strengths, which are the ones in
[its own table](diagnosis.md#by-effect), and besides those with coarse encoders and, of backlash and
flexibility, the further ones with fine encoders at the joints. `taut_hose`, a hose that resists two joints
once it is taut, is hidden in the blind run and is no effect of the catalogue.

Written by `make gallery`.
"""


def main() -> None:
    """Draw anew what is asked for, and write the page."""
    parser = argparse.ArgumentParser(prog="hidden.gallery")
    parser.add_argument("--only", default=",".join(CATALOGUE), help="effects, with commas between them")
    lines = kept() if KEPT.exists() else {}
    for name in parser.parse_args().only.split(","):
        with one_thread():
            line, charts = shown(name)
        lines[name] = line
        for part, chart in charts.items():
            path = DOCS / picture(name, part)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(sheet([chart], 1, SIZE), encoding="utf-8", newline="\n")
        rows = [json.dumps(lines[known]) for known in CATALOGUE if known in lines]
        KEPT.write_text("\n".join(rows) + "\n", encoding="utf-8")
        sys.stdout.write(f"{name}: {line['arm']}, {line['place']}\n")
        sys.stdout.flush()
    (DOCS / "gallery.md").write_text(page(lines, measured()), encoding="utf-8", newline="\n")


def kept() -> dict[str, Line]:
    """What the records showed, by effect."""
    rows = KEPT.read_text(encoding="utf-8").splitlines()
    return {line["effect"]: line for line in map(json.loads, rows)}


def picture(effect: str, part: str) -> str:
    """Path of a picture in the documentation. part: "law" or "residual"."""
    return f"gallery/{effect}-{part}.svg"


def shown(effect: str) -> tuple[Line, dict[str, Chart]]:
    """What is said of the records in which the effect is hidden, and their two charts."""
    f = found(effect)
    d, case = f.diagnosis, f.case
    cause, j = d.causes[0], judged_joint(d, 0)
    size, whole, unit = law_size(d, 0) or (float("nan"), float("nan"), "")
    charts = dict(zip(("law", "residual"), law_charts(d, 0), strict=True))
    return {
        "effect": effect,
        "arm": case.arm,
        "seed": case.seed,
        "encoder": case.encoder,
        "joint": f.joint,
        "magnitude": case.hidden[0].magnitude,
        "found": sentence(finding(d.arm, effect, cause.joint, cause.parameters)),
        "place": d.arm.coordinate_names[j],
        "size": number(size, 2),
        "whole": number(whole, 2),
        "unit": unit,
        "before": number(float(d.errors.before[j]), 3),
        "after": number(float(d.errors.after[j]), 3),
        "texts": {part: chart.text for part, chart in charts.items()},
        "lookalikes": _lookalikes(f),
    }, charts


def _lookalikes(f: Found) -> list[dict[str, Any]]:
    return [
        {
            "effect": x.effect,
            "share": round(x.share, 4),
            "test": None if x.test is None else x.test.text,
            "evidence": None if x.test is None else number(x.test.evidence or 0.0, 2),
        }
        for x in f.lookalikes
    ]


def page(lines: Mapping[str, Line], run: Sequence[Line]) -> str:
    """The page, from what was kept of every effect of the catalogue. run: lines of a blind run."""
    index = [f"- [{name}](#{name}): {effect.text}" for name, effect in CATALOGUE.items()]
    entries = ["\n".join(_entry(effect, lines[name], run)) for name, effect in CATALOGUE.items()]
    return "\n".join([HEAD, *index, "", "\n\n".join([*entries, MADE])])


def _entry(effect: type[Definition], line: Line, run: Sequence[Line]) -> Iterator[str]:
    name, texts = effect.name, line["texts"]
    drawn = [(f"The law of {name} with the values of an example.", f"effects/{name}.svg")]
    drawn += [(texts[part], picture(name, part)) for part in ("law", "residual")]
    yield from (f"## {name}", "", f"{sentence(effect.text)} Law: {law(name)}", "")
    yield from (f"![{text}]({path})" for text, path in drawn)
    yield from ("", f"**In a log.** {_log(line)} {_counted(name, run)}", "")
    rows = [_row(other, line) for other in effect.confused_with]
    heads = ["confused with", "its evidence here", "what separates the two", "expected delta BIC"]
    shown = len(heads) if any(row[-1] for row in rows) else len(heads) - 1
    yield f"| {' | '.join(heads[:shown])} |"
    yield "|---" * shown + "|"
    yield from (f"| {' | '.join(row[:shown])} |" for row in rows)
    reading = "" if effect.reading is None else f" Or read {effect.reading.text}."
    yield from ("", f"**Seen by itself in:** {effect.experiment}.{reading}", "")
    yield f"Parameters: [effects](effects.md#{name}). {effect.reference}."


def _log(line: Line) -> str:
    return f"Arm `{line['arm']}`{seen_by(line)}. {in_records(line)}"


def _counted(name: str, run: Sequence[Line]) -> str:
    """How often a blind run found it, and what was named instead or besides."""
    own = [x for x in run if x["group"] in GROUPS and x["effects"] == [name]]
    if not own:
        return ""
    hits = sum(x["result"] == "found" for x in own)
    instead = Counter(other for x in own for other, _ in x["named"] if other != name)
    others = [x for x in run if len(x["effects"]) == 1 and x["effects"] != [name]]
    wrong = Counter(x["effects"][0] for x in others if name in [other for other, _ in x["named"]])
    said = f"In [the blind run](diagnosis.md) it was hidden in {len(own)} arms and found in {hits}"
    if instead:
        said += f"; named instead or besides: {listed(f'{_link(x)} ({k})' for x, k in instead.items())}"
    if wrong:
        hidden = (
            f"{listed(f'{_link(x)} ({k})' for x, k in wrong.items())} {'was' if len(wrong) == 1 else 'were'}"
        )
        said += f". It was named where {hidden} hidden"
        if any(x["result"] == "found" for x in others if name in [other for other, _ in x["named"]]):
            said += ", in records in which the two are one"
    return f"{said}."


def _row(other: str, line: Line) -> tuple[str, ...]:
    tried = next((x for x in line["lookalikes"] if x["effect"] == other), None)
    seen = tried is not None and tried["share"] >= LEAST
    share = f"{100 * tried['share']:.0f} %" if tried is not None and seen else "none"
    if tried is None or tried["test"] is None or float(tried["evidence"]) < ENOUGH:
        return _link(other), share, CATALOGUE[other].experiment, ""
    return _link(other), share, tried["test"].split(" (")[0], f"{float(tried['evidence']):.0f}"


def _link(name: str) -> str:
    return f"[{name}](#{name})" if name in CATALOGUE else f"`{name}`"


if __name__ == "__main__":
    main()
