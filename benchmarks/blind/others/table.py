"""The table and the picture of what other methods do, from kept answers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import escape

from blind.case import Array
from blind.cases import Entry
from blind.judge import Verdict, group, judged, wilson
from blind.others.answers import OTHERS, Line, entry_of, lines
from blind.others.method import known, method
from modelgen.resources import templates_folder

DRAWS, SEED, QUANTILES = 2000, 1979, (0.025, 0.975)  # of the bootstrap over cases (Efron 1979)
SAME = 0.01  # relative difference of errors of the user's model beyond which two answers are to other records
OWN = "`modelgen diagnose`"
COLUMNS = (
    "method",
    "something of the catalogue hidden: exact",
    "nothing of it hidden: nothing named",
    "a false name, of all cases",
    "false names a case",
    "error removed, %",
)
WIDTH, LEFT, ROW, TOP, PANEL, GAP = 740, 186, 26, 46, 160, 28  # of the picture
Answered = Mapping[Entry, Line]


@dataclass(frozen=True)
class Score:
    """What a method did on the cases of the table. hidden, other, false: hits, and of how many cases;
    spurious: false names a case; removed: part of what the hidden effects add to the mean square error that
    it removes [%], with an interval of 95 %. names: whether it names anything at all.
    name: as it is called by, empty for modelgen.
    """

    name: str
    title: str
    names: bool
    hidden: tuple[int, int]
    other: tuple[int, int]
    false: tuple[int, int]
    spurious: float
    removed: tuple[float, float, float]


def scores(own: Sequence[Line], folder: Path = OTHERS) -> list[Score]:
    """Scores on those cases that modelgen and all methods with kept answers have answered, modelgen's first.

    own: kept truths and answers of modelgen.
    """
    others = {name: found for name in known() if (found := lines(name, folder))}
    if not others:
        return []
    ours = {entry_of(line["truth"]): line for line in own}
    entries = [e for e in ours if all(e in found and same(ours[e], found[e]) for found in others.values())]
    truths = {e: next(iter(others.values()))[e]["truth"] for e in entries}
    rows = [score("", OWN, ours, truths, names=True)]
    for name in sorted(others, key=lambda name: not method(name).names):
        by = method(name)
        rows.append(score(name, by.title, others[name], truths, names=by.names))
    return rows


def same(one: Line, other: Line) -> bool:
    """Whether two answers are to the same records: the user's model leaves the same, or one has no error."""
    before, again = (_errors(line["answer"], "before") for line in (one, other))
    if not before.any() or not again.any():
        return True
    return len(before) == len(again) and bool(np.allclose(before, again, rtol=SAME, atol=0.0))


def _errors(answer: Mapping[str, Any], when: str) -> Array:
    """Errors of an answer by joint (n,), 0 of one that does not move; (0,) where there are none."""
    found = ((answer.get("diagnosis") or {}).get("error") or {}).get(when) or []
    return np.array([x or 0.0 for x in found], dtype=float)


def score(
    name: str, title: str, answers: Answered, truths: Mapping[Entry, dict[str, Any]], *, names: bool
) -> Score:
    """Score of one method on these cases. truths: with the size that each has, `met`."""
    verdicts = {e: judged(said, answers[e]["answer"]) for e, said in truths.items()}
    hidden = [e for e, said in truths.items() if group(said) not in ("nothing", "outside")]
    other = [e for e in truths if e not in set(hidden)]
    false = [v for v in verdicts.values() if v.false_names]
    parts = np.array([part(truths[e], answers[e]["answer"]) for e in hidden]).reshape(-1, 2)
    return Score(
        name,
        title,
        names,
        (_exact(verdicts[e] for e in hidden), len(hidden)),
        (_exact(verdicts[e] for e in other), len(other)),
        (len(false), len(verdicts)),
        sum(len(v.false_names) for v in false) / max(len(verdicts), 1),
        pooled(parts),
    )


def _exact(answered: Iterable[Verdict]) -> int:
    return sum(v.exact for v in answered)


def part(said: Mapping[str, Any], answer: Mapping[str, Any]) -> tuple[float, float]:
    """Shares of the user's model's mean square error on the test record: that which an answer removes, and
    that which the hidden effect adds, 1 - 1 / s^2 for the size s that it has. At the joint where it acts, the
    mean over the joints where that is the whole arm. Who gives no answer removes nothing.
    """
    truth = said["truth"]
    adds = 1.0 - 1.0 / max(float(truth["met"]), 1.0) ** 2
    before, after = (_errors(answer, when) for when in ("before", "after"))
    places = [j - 1 for j in truth["joints"] if j is not None and j <= len(before)]
    where = places or [j for j, b in enumerate(before) if b]
    if not len(before) or not before[where].all():
        return 0.0, adds
    return float(np.mean(1.0 - (after[where] / before[where]) ** 2)), adds


def pooled(parts: Array) -> tuple[float, float, float]:
    """Removed over added of all cases (N, 2) together [%], with its interval of 95 %, by a bootstrap."""
    if not len(parts) or parts[:, 1].sum() <= 0:
        return (float("nan"),) * 3
    random = np.random.default_rng(SEED)
    drawn = parts[random.integers(len(parts), size=(DRAWS, len(parts)))].sum(axis=1)
    low, high = np.quantile(100.0 * drawn[:, 0] / drawn[:, 1], QUANTILES)
    removed, added = parts.sum(axis=0)
    return float(100.0 * removed / added), float(low), float(high)


def table(rows: Sequence[Score]) -> str:
    """The scores in Markdown."""
    cells = [list(COLUMNS), ["---"] * len(COLUMNS)]
    for s in rows:
        spurious = f"{s.spurious:.2f}" if s.names else "-"
        low, high = s.removed[1:]
        gone = f"{s.removed[0]:.0f} ({low:.0f} to {high:.0f})"
        counts = [_count(x) if s.names else "-" for x in (s.hidden, s.other, s.false)]
        cells.append([s.title, *counts, spurious, gone])
    return "\n".join(f"| {' | '.join(row)} |" for row in cells)


def _count(pair: tuple[int, int]) -> str:
    low, high = (100.0 * x for x in wilson(*pair))
    return f"{pair[0]} of {pair[1]} ({low:.0f} to {high:.0f} %)"


def picture(rows: Sequence[Score]) -> str:
    """The scores as SVG: a panel for each figure, a row for each method, its interval as a line."""
    style = (templates_folder() / "report" / "chart.css").read_text(encoding="utf-8")
    height = TOP + ROW * len(rows) + 26
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" class="sheet" viewBox="0 0 {WIDTH} {height}" '
        f'width="{WIDTH}" height="{height}">\n<style>\n{style}</style>',
        f'<rect class="paper" width="{WIDTH}" height="{height}"/>',
    ]
    for k, s in enumerate(rows):
        weight = ' font-weight="600"' if not k else ""
        parts.append(
            f'<text class="label" x="{LEFT - 14}" y="{_y(k) + 4}" text-anchor="end"{weight}>'
            f"{escape(s.title.replace('`', ''))}</text>"
        )
    panels = [
        ("exact, % of hidden", [(k, *_percent(s.hidden)) for k, s in enumerate(rows) if s.names]),
        ("a false name, % of all", [(k, *_percent(s.false)) for k, s in enumerate(rows) if s.names]),
        ("error removed, %", [(k, *s.removed) for k, s in enumerate(rows)]),
    ]
    for number, (title, points) in enumerate(panels):
        parts += _panel(LEFT + number * (PANEL + GAP), title, points, height)
    return "\n".join([*parts, "</svg>"]) + "\n"


def _y(row: int) -> int:
    return TOP + ROW * row + ROW // 2


def _percent(pair: tuple[int, int]) -> tuple[float, float, float]:
    low, high = wilson(*pair)
    return 100.0 * pair[0] / max(pair[1], 1), 100.0 * low, 100.0 * high


def _panel(x: int, title: str, points: Sequence[tuple[int, float, float, float]], height: int) -> list[str]:
    """One figure of all methods. points: row, value and interval [%]."""
    low = min(0.0, *(20.0 * np.floor(p[2] / 20.0) for p in points))
    high = max(100.0, *(20.0 * np.ceil(p[3] / 20.0) for p in points))
    bottom = height - 26

    def at(value: float) -> str:
        return f"{x + (PANEL - 8) * (value - low) / (high - low):.1f}"

    parts = [f'<text class="title" x="{x}" y="18">{escape(title)}</text>']
    for tick in (0, 50, 100):
        kind = "grid zero" if not tick else "grid"
        parts.append(f'<path class="{kind}" d="M{at(tick)} {TOP - 14}V{bottom}"/>')
        parts.append(
            f'<text class="tick" x="{at(tick)}" y="{bottom + 16}" text-anchor="middle">{tick}</text>'
        )
    for row, value, least, most in points:
        colour = "after" if not row else "before"
        parts.append(f'<path class="line {colour}" d="M{at(least)} {_y(row)}H{at(most)}"/>')
        parts.append(
            f'<circle cx="{at(value)}" cy="{_y(row)}" r="4.5" style="fill: var(--{colour})">'
            f"<title>{value:.0f} ({least:.0f} to {most:.0f})</title></circle>"
        )
    return parts
