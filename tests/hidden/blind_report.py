"""docs/diagnosis.md and its pictures from the lines of a blind run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hidden.blind_pictures import confusion, power
from hidden.effects import CATALOGUE, OUTSIDE
from hidden.tallies import Line, answered, of, wilson

STRONG = 1.1  # strength that the first lines speak of: 10 % of the error, which is worth finding
SHOWN = 25.0  # twice a log likelihood: evidence of 6 and the price of two parameters
HEAD = """\
# Diagnosis: measured

*How often is the diagnosis right, and how often does it name something that is not there?*
"""
ADVICE = """\
Backlash and flexibility are counted apart, below. The arms are simulated by this project. On arms by other
equations the answer is [less often right](strangers.md); what is found in real ones is in the
[case studies](case-studies.md). So record as many motions as these figures are for, and before you act on a
name, try the motion in which the effect is seen by itself: the [gallery](gallery.md) has one for each.

## All questions

In brackets: 95 % Wilson intervals, in %. The strength s is the error of the standard model with the effect
over the error without it: at 1.05 it adds 5 %.
"""
HOW = """\
## How to measure it again

`make blind SEED={again}` writes this page, in hours; every case with its answer is in
`tests/hidden/runs/{seed}.jsonl`. Seed {seed}, commit {commit}. {runs}
A case is undrawn where the effect reaches the strength on no plausible arm of the draw. How the diagnosis
decides is on [a page of its own](diagnosis_method.md).

The plant shares no code with modelgen (`tests/hidden`): other functional forms of the effects, another
integrator (Moreau's midpoint stepping with set-valued friction), arms of 2 to 6 joints with direct and
levered drives. Training records and a test record of 30 s at 500 Hz, each three periods of a Fourier
trajectory of its own of 0.1 to 0.5 Hz; encoders of 4096 counts at the motor; current noise, 5 % white and 2 %
coloured, of the RMS without the effect. The strength s is the held-out RMSE of the standard model with the
effect over without, on the affected joint, by the plant's own least squares below 15 Hz, each record held out
in its turn (two records for training, whatever their number below); of an effect from outside the catalogue,
what a spring and a constant current at each joint leave. A fit to few motions can take up what then costs 5 %
on another: shown in the training records is an effect by which twice the log likelihood of the plant's own
fit to them is expected to fall by {shown:g}, with the noise's colour known, which a cause with two parameters
needs for its name.
"""
PICTURES = (
    "",
    "![Share found over the strength, by effect](diagnosis_power.svg)",
    "",
    "![What was named, by what was hidden](diagnosis_confusion.svg)",
    "",
)


def rate(lines: list[Line], test: str, value: Any = True) -> str:
    """`hits of total, share (interval)` for a table."""
    return proportion(sum(line[test] == value for line in lines), len(lines))


def proportion(hits: int, total: int) -> str:
    """`hits of total, share (interval)`."""
    if not total:
        return "no case"
    low, high = wilson(hits, total)
    return f"{hits} of {total}: {100 * hits / total:.1f} % ({100 * low:.1f} to {100 * high:.1f})"


def write(lines: list[Line], docs: Path, planned: int) -> None:
    """The page and its pictures into `docs`, the same for the same lines.

    lines: of one seed. planned: cases of the matrix.

    A column of answers for each number of training records; the pictures and the table of effects are of the
    smallest.
    """
    lines = sorted(lines, key=lambda line: (line["train"], line["key"]))
    runs = {count: [line for line in lines if line["train"] == count] for count in _counts(lines)}
    first = next(filter(None, map(answered, runs.values())), [])
    docs.mkdir(parents=True, exist_ok=True)
    confusion(first, docs / "diagnosis_confusion.svg")
    power(runs, docs / "diagnosis_power.svg")
    how = HOW.format(
        again=min((line["seed"] for line in lines), default="n"),
        seed=" and ".join(sorted({str(line["seed"]) for line in lines})),
        commit=" and ".join(sorted({line["commit"] for line in lines})),
        runs="\n".join(_stated(count, own, planned) for count, own in runs.items()),
        shown=SHOWN,
    )
    page = [
        HEAD,
        *_short(first),
        ADVICE,
        *_table(runs),
        *PICTURES,
        *_by_effect(first),
        "",
        how,
        *_failures(lines),
    ]
    (docs / "diagnosis.md").write_text("\n".join(page) + "\n", encoding="utf-8")


def _short(good: list[Line]) -> list[str]:
    """What a reader asks first, for one number of training records."""
    if not good:
        return []
    rigid, hidden = of(good, "single", STRONG, compliant=False), of(good, "outside")
    asked = (
        ("nothing is hidden, and a cause is named", _share(of(good, "null"), "wrong")),
        (
            f"one effect adds {100 * STRONG - 100:.0f} % to the error: it is named, nothing else",
            _share(rigid, "found"),
        ),
        ("two effects together: both are named, nothing else", _share(of(good, "pair"), "found")),
        ("something that the catalogue does not have: a cause is named", _share(hidden, "wrong")),
    )
    rows = (f"| {text} | {share} |" for text, share in asked)
    head = f"| with {good[0]['train']} training records | cases |"
    return [head, "|---|---|", *rows, ""]


def _share(lines: list[Line], result: str) -> str:
    return f"{sum(line['result'] == result for line in lines)} of {len(lines)}" if lines else "no case"


def _counts(lines: list[Line]) -> list[int]:
    return sorted({line["train"] for line in lines})


def _stated(train: int, lines: list[Line], planned: int) -> str:
    failed, undrawn = (sum(word in line for line in lines) for word in ("failed", "no_case"))
    return (
        f"{train} training records: {len(lines)} of {planned} cases, {len(answered(lines))} answered, "
        f"{failed} failed, {undrawn} undrawn."
    )


def _table(runs: dict[int, list[Line]]) -> list[str]:
    every = [answered(lines) for lines in runs.values()]
    strengths = sorted({line["strength"] for lines in every for line in of(lines, "single")})
    columns = [_answers(lines, strengths) for lines in every]
    rows = [[asked[0][0], *(answer for _, answer in asked)] for asked in zip(*columns, strict=True)]
    head = ["question", *(f"{train} training records" for train in runs)]
    return [f"| {' | '.join(row)} |" for row in (head, ["---"] * len(head), *rows)]


def _answers(good: list[Line], strengths: list[float]) -> list[tuple[str, str]]:
    """Questions, and what the lines answer. strengths: of single effects."""
    nulls, singles, outside, coarse, free = (
        of(good, group) for group in ("null", "single", "outside", "coarse", "free")
    )
    out = [
        ("nothing hidden: something named", rate(nulls, "result", "wrong")),
        ("nothing hidden: `nothing_missing`", rate(nulls, "verdict", "nothing_missing")),
    ]
    for strength in strengths:
        rigid = of(good, "single", strength, compliant=False)
        soft = of(good, "single", strength, compliant=True)
        shown = [line for line in rigid if line["shown"] > SHOWN]
        one, two = f"one effect, s = {strength:g}", f"backlash or flexibility, s = {strength:g}"
        out += [
            (f"{one}: cause and joint, no extra", rate(rigid, "result", "found")),
            (f"{one}, shown in the training records: cause and joint", rate(shown, "result", "found")),
            (f"{one}: something else named", rate(rigid, "result", "wrong")),
            (f"{two}: the class", rate(soft, "by_class", "found")),
            (f"{two}: the member", rate(soft, "result", "found")),
        ]
    named = [line for line in singles if line["named"]]
    recovered = [line["recovered"] for line in singles if line.get("recovered") is not None]
    hidden = [line for line in coarse if line["effects"]]
    most = sum(value >= 0.9 for value in recovered)
    size = f"{sum(line['size'] for line in named) / len(named):.2f}" if named else "no case"
    return [
        *out,
        (
            "link-side encoder: backlash or flexibility, s = 1.3, the member",
            rate(of(good, "link_side"), "result", "found"),
        ),
        ("two effects, s = 1.15 each: both, no extra", rate(of(good, "pair"), "result", "found")),
        ("outside the catalogue, s = 1.3: `outside_catalogue`", rate(outside, "result", "found")),
        ("outside the catalogue, s = 1.3: something named", rate(outside, "result", "wrong")),
        ("something named: the truth in the ambiguity set", rate(named, "in_set")),
        ("mean size of an ambiguity set", size),
        ("share of the recoverable error recovered, median (10th percentile)", _quantiles(recovered)),
        ("recovered at least 90 %", proportion(most, len(recovered))),
        ("14-bit joint encoders: a wrong name", rate(coarse, "result", "wrong")),
        ("14-bit joint encoders, s = 1.3: cause and joint", rate(hidden, "result", "found")),
        (
            "free motion: right answer, or one that these motions cannot tell from it",
            rate(free, "result", "found"),
        ),
        ("free motion: a wrong name", rate(free, "result", "wrong")),
        ("seconds for a diagnosis, median (longest)", _seconds(good)),
    ]


def _by_effect(good: list[Line]) -> list[str]:
    if not good:
        return []
    out = [
        "## By effect",
        "",
        f"With {good[0]['train']} training records. Counted are the cases with one effect and fine",
        "encoders, at the strengths of the questions above. Those with coarse encoders, and the further",
        "ones of backlash and flexibility with encoders at the joints, are counted in the",
        "[gallery](gallery.md) besides, whose numbers are larger.",
        "",
        "| hidden | found | missed | wrong or extra | named instead or besides |",
        "|---|---|---|---|---|",
    ]
    for effect in (*CATALOGUE, *OUTSIDE):
        own = [line for group in ("single", "outside") for line in of(good, group)]
        own = [line for line in own if line["effects"] == [effect]]
        if not own:
            continue
        counts = [sum(line["result"] == result for line in own) for result in ("found", "missed", "wrong")]
        others = sorted({name for line in own for name, _ in line["named"] if name != effect})
        named = ", ".join(f"`{name}`" for name in others) or "–"
        out.append(f"| `{effect}` | {counts[0]} | {counts[1]} | {counts[2]} | {named} |")
    return out


def _failures(lines: list[Line]) -> list[str]:
    failed = [line for line in lines if "failed" in line]
    texts = [
        f"- `{line['key']}`, {line['train']} training records: {line['failed'].strip().splitlines()[-1]}"
        for line in failed
    ]
    return ["", "## Failed", "", *texts] if failed else []


def _quantiles(values: list[float]) -> str:
    if not values:
        return "no case"
    ordered = sorted(values)
    return f"{ordered[len(ordered) // 2]:.2f} ({ordered[len(ordered) // 10]:.2f})"


def _seconds(lines: list[Line]) -> str:
    by: dict[str, list[float]] = {}
    for line in lines:
        by.setdefault(line["case"]["arm"], []).append(line["seconds"])
    parts = [f"{arm} {sorted(own)[len(own) // 2]:.1f} ({max(own):.1f})" for arm, own in sorted(by.items())]
    return ", ".join(parts) or "no case"
