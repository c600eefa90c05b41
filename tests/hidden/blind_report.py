"""docs/diagnosis.md and its pictures from the lines of a blind run."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt

from hidden.effects import CATALOGUE, OUTSIDE

Line = dict[str, Any]
COMPLIANT = ("backlash", "joint_flexibility")
SOFT = ("backlash, flexibility", "C1")  # label and colour
SHOWN = 25.0  # twice a log likelihood: evidence of 6 and the price of two parameters
HEAD = """\
# Diagnosis: measured

What `modelgen diagnose` answers on logs of simulated arms with something hidden in them. Written by
`make blind`; the method is in [diagnosis_method.md](diagnosis_method.md).

Seed {seed}, commit {commit}. {runs}
A case is undrawn where the effect reaches the strength on no plausible arm of the draw.

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
needs for its name. In brackets: 95 % Wilson intervals, in %.
"""
PICTURES = (
    "",
    "![Share found over the strength, by effect](diagnosis_power.svg)",
    "",
    "![What was named, by what was hidden](diagnosis_confusion.svg)",
    "",
)


def wilson(hits: int, total: int, z: float = 1.96) -> tuple[float, float]:
    """Interval of a proportion (Wilson 1927); (0, 1) without cases."""
    if total == 0:
        return 0.0, 1.0
    share, square = hits / total, z * z / total
    centre = (share + square / 2) / (1 + square)
    half = z * math.sqrt(share * (1 - share) / total + square / (4 * total)) / (1 + square)
    return max(0.0, centre - half), min(1.0, centre + half)


def rate(lines: list[Line], test: str, value: Any = True) -> str:
    """`hits of total, share (interval)` for a table."""
    return proportion(sum(line[test] == value for line in lines), len(lines))


def proportion(hits: int, total: int) -> str:
    """`hits of total, share (interval)`."""
    if not total:
        return "no case"
    low, high = wilson(hits, total)
    return f"{hits} of {total}: {100 * hits / total:.1f} % ({100 * low:.1f} to {100 * high:.1f})"


def write(lines: list[Line], seed: int, commit: str, docs: Path, planned: int) -> None:
    """The page and its pictures into `docs`, the same for the same lines; `planned`: cases of the matrix.

    A column of answers for each number of training records; the pictures and the table of effects are of the
    smallest.
    """
    lines = sorted(lines, key=lambda line: (line["train"], line["key"]))
    runs = {count: [line for line in lines if line["train"] == count] for count in _counts(lines)}
    first = _answered(next(iter(runs.values()), []))
    docs.mkdir(parents=True, exist_ok=True)
    _confusion(first, docs / "diagnosis_confusion.svg")
    _power(runs, docs / "diagnosis_power.svg")
    head = HEAD.format(
        seed=seed,
        commit=commit[:12],
        runs="\n".join(_stated(count, own, planned) for count, own in runs.items()),
        shown=SHOWN,
    )
    page = [head, *_table(runs), *PICTURES, *_by_effect(first), *_failures(lines)]
    (docs / "diagnosis.md").write_text("\n".join(page) + "\n", encoding="utf-8")


def _counts(lines: list[Line]) -> list[int]:
    return sorted({line["train"] for line in lines})


def _answered(lines: list[Line]) -> list[Line]:
    return [line for line in lines if "result" in line]


def _stated(train: int, lines: list[Line], planned: int) -> str:
    failed, undrawn = (sum(word in line for line in lines) for word in ("failed", "no_case"))
    return (
        f"{train} training records: {len(lines)} of {planned} cases, {len(_answered(lines))} answered, "
        f"{failed} failed, {undrawn} undrawn."
    )


def _of(
    lines: list[Line], group: str, strength: float | None = None, compliant: bool | None = None
) -> list[Line]:
    return [
        line
        for line in lines
        if line["group"] == group
        and (strength is None or line["strength"] == strength)
        and (compliant is None or (line["effects"] and line["effects"][0] in COMPLIANT) == compliant)
    ]


def _table(runs: dict[int, list[Line]]) -> list[str]:
    columns = [dict(_answers(_answered(lines))) for lines in runs.values()]
    questions = list(dict.fromkeys(question for column in columns for question in column))
    rows = [[question, *(column.get(question, "no case") for column in columns)] for question in questions]
    head = ["question", *(f"{train} training records" for train in runs)]
    return [f"| {' | '.join(row)} |" for row in (head, ["---"] * len(head), *rows)]


def _answers(good: list[Line]) -> list[tuple[str, str]]:
    """Questions, and what the lines answer."""
    nulls, singles, outside, coarse, free = (
        _of(good, group) for group in ("null", "single", "outside", "coarse", "free")
    )
    out = [
        ("nothing hidden: something named", rate(nulls, "result", "wrong")),
        ("nothing hidden: `nothing_missing`", rate(nulls, "verdict", "nothing_missing")),
    ]
    for strength in sorted({line["strength"] for line in singles}):
        rigid = _of(good, "single", strength, compliant=False)
        soft = _of(good, "single", strength, compliant=True)
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
            rate(_of(good, "link_side"), "result", "found"),
        ),
        ("two effects, s = 1.15 each: both, no extra", rate(_of(good, "pair"), "result", "found")),
        ("outside the catalogue, s = 1.3: `outside_catalogue`", rate(outside, "result", "found")),
        ("outside the catalogue, s = 1.3: something named", rate(outside, "result", "wrong")),
        ("something named: the truth in the ambiguity set", rate(named, "in_set")),
        ("mean size of an ambiguity set", size),
        ("share of the recoverable error recovered, median (10th percentile)", _quantiles(recovered)),
        ("recovered at least 90 %", proportion(most, len(recovered))),
        ("14-bit joint encoders: a wrong name", rate(coarse, "result", "wrong")),
        ("14-bit joint encoders, s = 1.3: cause and joint", rate(hidden, "result", "found")),
        ("free motion: right answer", rate(free, "result", "found")),
        ("free motion: a wrong name", rate(free, "result", "wrong")),
        ("seconds for a diagnosis, median (longest)", _seconds(good)),
    ]


def _by_effect(good: list[Line]) -> list[str]:
    out = [
        "## By effect",
        "",
        f"With {' and '.join(str(count) for count in _counts(good))} training records.",
        "",
        "| hidden | found | missed | wrong or extra | named instead or besides |",
        "|---|---|---|---|---|",
    ]
    for effect in (*CATALOGUE, *OUTSIDE):
        own = [line for group in ("single", "outside") for line in _of(good, group)]
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
    texts = [f"- `{line['key']}`: {line['failed'].strip().splitlines()[-1]}" for line in failed]
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


def _save(figure: Any, path: Path) -> None:
    with mpl.rc_context({"svg.hashsalt": "modelgen", "svg.fonttype": "none"}):
        figure.savefig(path, format="svg", metadata={"Date": None}, bbox_inches="tight")
    plt.close(figure)


def _power(runs: dict[int, list[Line]], path: Path) -> None:
    """Curves of each number of training records; in grey single effects, with the fewest."""
    figure, axis = plt.subplots(figsize=(7.5, 4.2))
    for place, (train, lines) in enumerate(runs.items()):
        good = _answered(lines)
        strengths = sorted({line["strength"] for line in _of(good, "single")})
        for compliant, label, colour in ((False, "all other effects", "C0"), (True, *SOFT)):
            cells = [_of(good, "single", strength, compliant) for strength in strengths]
            hits = [
                sum(line["by_class" if compliant else "result"] == "found" for line in cell) for cell in cells
            ]
            share = [100 * n / len(cell) if cell else math.nan for n, cell in zip(hits, cells, strict=True)]
            ends = [wilson(n, len(cell)) for n, cell in zip(hits, cells, strict=True)]
            below = [max(0.0, value - 100 * low) for value, (low, _) in zip(share, ends, strict=True)]
            above = [max(0.0, 100 * high - value) for value, (_, high) in zip(share, ends, strict=True)]
            axis.errorbar(
                [strength + 0.004 * place for strength in strengths],
                share,
                [below, above],
                marker="os^"[place % 3],
                linestyle=("-", "--", ":")[place % 3],
                capsize=4,
                color=colour,
                label=f"{label}, {train} training records",
            )
        for effect in CATALOGUE if not place else ():
            own = [
                [line for line in _of(good, "single", s) if line["effects"] == [effect]] for s in strengths
            ]
            hits = [sum(line["result"] == "found" for line in cell) for cell in own]
            curve = [100 * n / len(cell) if cell else math.nan for n, cell in zip(hits, own, strict=True)]
            axis.plot(strengths, curve, color="0.8", linewidth=0.7, zorder=0)
    axis.set(xlabel="strength s", ylabel="cause and joint found [%]", ylim=(-3, 103))
    if axis.get_legend_handles_labels()[0]:
        axis.legend(loc="lower right")
    axis.grid(alpha=0.3)
    _save(figure, path)


def _confusion(lines: list[Line], path: Path) -> None:
    rows = [*CATALOGUE, *OUTSIDE, "nothing"]
    columns = [*CATALOGUE, "nothing named"]
    counts = [[0.0] * len(columns) for _ in rows]
    for line in lines:
        if line["group"] not in ("null", "single", "outside"):
            continue
        row = rows.index(line["effects"][0] if line["effects"] else "nothing")
        answers = [name for name, _ in line["named"]] or ["nothing named"]
        for name in answers:
            if name in columns:
                counts[row][columns.index(name)] += 1.0 / len(answers)
    shares = [[value / max(1.0, sum(row)) for value in row] for row in counts]
    figure, axis = plt.subplots(figsize=(9.5, 9.5))
    axis.imshow(shares, cmap="Blues", vmin=0, vmax=1)
    for i, row in enumerate(counts):
        for j, value in enumerate(row):
            if value:
                colour = "white" if shares[i][j] > 0.6 else "black"
                axis.text(
                    j,
                    i,
                    f"{value:g}" if value % 1 == 0 else f"{value:.1f}",
                    ha="center",
                    va="center",
                    fontsize=7,
                    color=colour,
                )
    axis.set_xticks(range(len(columns)), columns, rotation=90, fontsize=8)
    axis.set_yticks(range(len(rows)), rows, fontsize=8)
    axis.set(xlabel="named", ylabel="hidden")
    _save(figure, path)
