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
SHOWN = 25.0  # twice a log likelihood: evidence of 6 and the price of two parameters
HEAD = """\
# Diagnosis: measured

What `modelgen diagnose` answers on logs of simulated arms with something hidden in them. Written by
`make blind`; the method is in [diagnosis_method.md](diagnosis_method.md).

Seed {seed}, commit {commit}, {lines} of {planned} cases: {answered} answered, {failed} failed, {undrawn}
could not be drawn (the effect reaches the strength on no plausible arm of the draw).

The plant shares no code with modelgen (`tests/hidden`): other functional forms of the effects, another
integrator (Moreau's midpoint stepping with set-valued friction), arms of 2 to 6 joints with direct and
levered drives. Two training records and a test record of 30 s at 500 Hz, each three periods of a Fourier
trajectory of 0.1 to 0.5 Hz; encoders of 4096 counts at the motor; current noise, 5 % white and 2 %
coloured, of the RMS without the effect. The strength s is the held-out RMSE of the standard model with the
effect over without, on the affected joint, by the plant's own least squares below 15 Hz, each record held out
in its turn; of an effect from outside the catalogue, what a spring and a constant current at each joint
leave. A fit to few motions can take up what then costs 5 % on another: shown in the training records is an
effect by which twice the log likelihood of the plant's own fit to them, with the noise's colour known, falls
by {shown:g}, which a cause with two parameters needs for its name. In brackets: 95 % Wilson
intervals, in %.
"""


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
    """The page and its pictures into `docs`, the same for the same lines; `planned`: cases of the matrix."""
    lines = sorted(lines, key=lambda line: line["key"])
    good = [line for line in lines if "result" in line]
    docs.mkdir(parents=True, exist_ok=True)
    _confusion(good, docs / "diagnosis_confusion.svg")
    _power(good, docs / "diagnosis_power.svg")
    (docs / "diagnosis.md").write_text(
        "\n".join(_page(lines, good, seed, commit, planned)) + "\n", encoding="utf-8"
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


def _page(lines: list[Line], good: list[Line], seed: int, commit: str, planned: int) -> list[str]:
    nulls, pairs = _of(good, "null"), _of(good, "pair")
    counts = (len(good), sum("failed" in line for line in lines), sum("no_case" in line for line in lines))
    out = [
        HEAD.format(
            planned=planned,
            seed=seed,
            commit=commit[:12],
            lines=len(lines),
            answered=counts[0],
            failed=counts[1],
            undrawn=counts[2],
            shown=SHOWN,
        ),
        "| question | measured |",
        "|---|---|",
        f"| nothing hidden: something named | {rate(nulls, 'result', 'wrong')} |",
        f"| nothing hidden: `nothing_missing` | {rate(nulls, 'verdict', 'nothing_missing')} |",
    ]
    for strength in sorted({line["strength"] for line in _of(good, "single")}):
        rigid = _of(good, "single", strength, compliant=False)
        soft = _of(good, "single", strength, compliant=True)
        out += [
            f"| one effect, s = {strength:g}: cause and joint, no extra | {rate(rigid, 'result', 'found')} |",
            f"| of these, shown in the training records: cause and joint | "
            f"{rate([x for x in rigid if x.get('shown', math.inf) > SHOWN], 'result', 'found')} |",
            f"| one effect, s = {strength:g}: something else named | {rate(rigid, 'result', 'wrong')} |",
            f"| backlash or flexibility, s = {strength:g}: the class | {rate(soft, 'by_class', 'found')} |",
            f"| backlash or flexibility, s = {strength:g}: the member | {rate(soft, 'result', 'found')} |",
        ]
    singles = _of(good, "single")
    named = [line for line in singles if line["named"]]
    recovered = [line["recovered"] for line in singles if line.get("recovered") is not None]
    size = sum(line["size"] for line in named) / len(named) if named else math.nan
    outside = _of(good, "outside")
    coarse = _of(good, "coarse")
    hidden = [line for line in coarse if line["effects"]]
    free = _of(good, "free")
    out += [
        f"| link-side encoder: backlash or flexibility, s = 1.3, the member | "
        f"{rate(_of(good, 'link_side'), 'result', 'found')} |",
        f"| two effects, s = 1.15 each: both, no extra | {rate(pairs, 'result', 'found')} |",
        f"| outside the catalogue, s = 1.3: `outside_catalogue` | {rate(outside, 'result', 'found')} |",
        f"| outside the catalogue, s = 1.3: something named | {rate(outside, 'result', 'wrong')} |",
        f"| something named: the truth in the ambiguity set | {rate(named, 'in_set')} |",
        f"| mean size of an ambiguity set | {size:.2f} |",
        f"| share of the recoverable error recovered, median (10th percentile) | {_quantiles(recovered)} |",
        f"| recovered at least 90 % | {proportion(sum(v >= 0.9 for v in recovered), len(recovered))} |",
        f"| 14-bit joint encoders: a wrong name | {rate(coarse, 'result', 'wrong')} |",
        f"| 14-bit joint encoders, s = 1.3: cause and joint | {rate(hidden, 'result', 'found')} |",
        f"| free motion: right answer | {rate(free, 'result', 'found')} |",
        f"| free motion: a wrong name | {rate(free, 'result', 'wrong')} |",
        f"| seconds for a diagnosis, median (longest) | {_seconds(good)} |",
        "",
        "![Share found over the strength, by effect](diagnosis_power.svg)",
        "",
        "![What was named, by what was hidden](diagnosis_confusion.svg)",
        "",
        "## By effect",
        "",
        "| hidden | found | missed | wrong or extra | named instead or besides |",
        "|---|---|---|---|---|",
    ]
    for effect in (*CATALOGUE, *OUTSIDE):
        own = [line for line in (*singles, *outside) if line["effects"] == [effect]]
        if not own:
            continue
        counts = [sum(line["result"] == result for line in own) for result in ("found", "missed", "wrong")]
        others = sorted({name for line in own for name, _ in line["named"] if name != effect})
        shown = ", ".join(f"`{name}`" for name in others) or "–"
        out.append(f"| `{effect}` | {counts[0]} | {counts[1]} | {counts[2]} | {shown} |")
    failures = [line for line in lines if "failed" in line]
    if failures:
        out += ["", "## Failed", ""]
        out += [f"- `{line['key']}`: {line['failed'].strip().splitlines()[-1]}" for line in failures]
    return out


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


def _power(lines: list[Line], path: Path) -> None:
    strengths = sorted({line["strength"] for line in _of(lines, "single")})
    figure, axis = plt.subplots(figsize=(7.5, 4.2))
    for compliant, label, colour in (
        (False, "all other effects", "C0"),
        (True, "backlash, flexibility", "C1"),
    ):
        shares, below, above = [], [], []
        for strength in strengths:
            own = _of(lines, "single", strength, compliant)
            hits = sum(line["by_class" if compliant else "result"] == "found" for line in own)
            low, high = wilson(hits, len(own))
            share = hits / len(own) if own else math.nan
            shares.append(100 * share)
            below.append(100 * max(0.0, share - low) if own else 0.0)
            above.append(100 * max(0.0, high - share) if own else 0.0)
        axis.errorbar(strengths, shares, [below, above], marker="o", capsize=4, color=colour, label=label)
    for effect in CATALOGUE:
        own = [[line for line in _of(lines, "single", s) if line["effects"] == [effect]] for s in strengths]
        hits = [sum(line["result"] == "found" for line in cell) for cell in own]
        curve = [100 * n / len(cell) if cell else math.nan for n, cell in zip(hits, own, strict=True)]
        axis.plot(strengths, curve, color="0.8", linewidth=0.7, zorder=0)
    axis.set(xlabel="strength s", ylabel="cause and joint found [%]", ylim=(-3, 103))
    if strengths:
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
