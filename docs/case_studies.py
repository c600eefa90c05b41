"""The pictures of the case studies, out of what `modelgen diagnose` wrote.

    python docs/case_studies.py law FOLDER NUMBER FILE.svg     the law of a cause, as in the report of FOLDER
    python docs/case_studies.py speed FOLDER JOINT FILE.svg    mean residuals of a joint over its speed
    python docs/case_studies.py time FOLDER JOINT FILE.svg     residuals of a joint over time
    python docs/case_studies.py ur10                           bars, from the table of the page

The charts are those of the reports, put into files of their own: by day and by night, at any width. Same
input, same bytes.
"""

from __future__ import annotations

import re
import sys
from html import unescape
from pathlib import Path

from markupsafe import escape

from modelgen.resources import templates_folder

HERE = Path(__file__).resolve().parent
PLACE = HERE / "case-studies"
WIDTH, HEIGHT, STRIP = 440, 220, 44  # of a chart, and what stands above it
LONG = 10  # letters of a joint's name that have room below its bars
CHART = re.compile(
    r"<text class=\"title\"[^>]*>(.*?)</text>\n<svg x=[^>]*>(.*?)</svg>(?=\n<text class=\"title\"|\n</svg>)",
    re.DOTALL,
)
LAW = re.compile(r"<figure><figcaption>(.*?)</figcaption>(<svg class=\"chart\".*?)</figure>", re.DOTALL)
ROLES = ("measured", "before", "after")  # looks of the bars: published, as described, extended


def law(folder: Path, number: int) -> str:
    """The chart of the law found for the cause of that number, from 1 on. Raises ValueError without one."""
    text = (folder / "report.html").read_text(encoding="utf-8")
    sections = re.split(r"<h2[^>]*>The law found", text)[1:]
    found = LAW.search(sections[number - 1])
    if not found:
        raise ValueError(f"{folder}: the cause {number} has no chart of its law")
    key = [("dots measured", "effort without the rest of the model"), ("line law", "law found")]
    return _alone(unescape(found[1]), found[2], key)


def residual(folder: Path, joint: int, over: str) -> str:
    """Residuals of a joint, from 1 on, over time, or their means over its speed."""
    name, columns, column = {"time": ("effort.svg", 2, 1), "speed": ("residuals.svg", 3, 0)}[over]
    text = (folder / name).read_text(encoding="utf-8")
    title, chart = CHART.findall(text)[columns * (joint - 1) + column]
    key = [("line before", "model as described")]
    if "extended model" in text:
        key.append(("line after", "extended model"))
    return _alone(unescape(title) if over == "time" else f"{unescape(title)}: mean residual", chart, key)


def bars(rows: dict[str, list[float]], joints: list[str], of: str) -> str:
    """Errors by joint, a bar for each row of a table. of: the end of the title, with the unit."""
    highest = max(max(values) for values in rows.values())
    names = [name.replace("_", "_\n").split("\n") if len(name) > LONG else [name] for name in joints]
    floor = HEIGHT - 12 - 12 * max(map(len, names))
    group = (WIDTH - 40) / len(joints)
    wide = 0.8 * group / len(rows)
    parts = []
    for k in range(4):
        value = 0.1 * k
        y = floor - (floor - 20) * value / highest
        parts.append(f'<path class="grid" d="M36 {y:.1f}H{WIDTH}"/>')
        parts.append(f'<text class="tick" x="32" y="{y + 4:.1f}" text-anchor="end">{value:.1f}</text>')
    for j, lines in enumerate(names):
        left = 40 + group * j
        for k, (role, values) in enumerate(zip(ROLES, rows.values(), strict=True)):
            high = (floor - 20) * values[j] / highest
            parts.append(_bar(role, left + wide * k, floor - high, wide - 1.0, high))
        middle = left + 0.4 * group
        parts += [
            f'<text class="tick" x="{middle:.1f}" y="{floor + 16 + 12 * k}" text-anchor="middle">'
            f"{escape(line)}</text>"
            for k, line in enumerate(lines)
        ]
    key = [(f"bar {role}", name) for role, name in zip(ROLES, rows, strict=True)]
    return _alone(f"RMSE on the held-out record{of}", "".join(parts), key)


def _bar(role: str, x: float, y: float, wide: float, high: float) -> str:
    """A bar, light, dark or hollow: on paper without colours too."""
    look = f"fill: var(--{role})"
    if role == "after":
        x, y, wide, high = x + 1.0, y + 1.0, wide - 2.0, max(high - 1.0, 0.5)
        look = f"fill: none; stroke: var(--{role}); stroke-width: 2px"
    return f'<rect x="{x:.1f}" y="{y:.1f}" width="{wide:.1f}" height="{high:.1f}" style="{look}"/>'


def ur10() -> str:
    """The bars of the table of the UR10."""
    page = (HERE / "case-studies.md").read_text(encoding="utf-8")
    section = page[page.index("## UR10") : page.index("## EMPS")]
    table = re.findall(r"^\|[ -].*\|$", section, re.MULTILINE)
    head, _, *rest = [[cell.strip() for cell in line.strip("|").split("|")] for line in table]
    rows = {row[0]: [float(cell) for cell in row[1:]] for row in rest}
    band = re.findall(r"up to [\d.]+ Hz", head[0])[0]
    return bars(rows, head[1:], f", {band} [A]")


def _alone(title: str, chart: str, key: list[tuple[str, str]]) -> str:
    """A chart with its title and legend as a file."""
    style = (templates_folder() / "report" / "chart.css").read_text(encoding="utf-8")
    height = HEIGHT + STRIP
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" class="sheet" viewBox="0 0 {WIDTH} {height}" '
        f'width="{WIDTH}" height="{height}">\n<style>\n{style}</style>',
        f'<rect class="paper" width="{WIDTH}" height="{height}"/>',
        f'<text class="title" x="4" y="14">{escape(title)}</text>',
    ]
    at = 4.0
    for role, label in key:
        dots, bar = role.startswith("dots"), role.removeprefix("bar ")
        if bar != role:  # as the bars are: an area of their colour
            parts.append(_bar(bar, at + 7, 26.0, 13.0, 11.0))
        else:
            parts.append(f'<path class="{role}" d="M{at + (10 if dots else 0):g} 32h{0 if dots else 20}"/>')
        parts.append(f'<text class="label" x="{at + 26:g}" y="36">{escape(label)}</text>')
        at += 26 + 6.3 * len(label) + 16
    parts.append(f'<svg y="{STRIP}" width="{WIDTH}" height="{HEIGHT}">{chart}</svg>')
    return "\n".join([*parts, "</svg>"]) + "\n"


def main(words: list[str]) -> None:
    """Write a picture."""
    if words == ["ur10"]:
        (PLACE / "ur10.svg").write_text(ur10(), encoding="utf-8")
        return
    kind, folder, number, file = words
    place, k = Path(folder), int(number)
    made = law(place, k) if kind == "law" else residual(place, k, kind)
    (PLACE / file).write_text(made, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
