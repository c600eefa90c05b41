"""A fleet on one page: how many of what, and every unit with the way to its report."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from modelgen.diagnosis.result import VERDICTS
from modelgen.figures import figure, svg
from modelgen.fleet.store import Row
from modelgen.resources import templates_folder

FAILED = "failed"
WORDS = {
    "named": "cause named",
    "suspected": "cause suspected",
    "nothing_missing": "nothing missing",
    "outside_catalogue": "outside the catalogue",
    "cannot_tell": "cannot tell",
    FAILED: "failed",
}
COLOURS = {
    "named": "#1f5fa8",
    "suspected": "#7fa8d1",
    "nothing_missing": "#3a8f4d",
    "outside_catalogue": "#d1661a",
    "cannot_tell": "#999999",
    FAILED: "#b3261e",
}
# By joint; causes of the whole arm come last.
_JOINTS = ("#123a66", "#4f8acb", "#a9cbee", "#d1661a", "#f0b27a", "#7a4a1d", "#666666")
_ARM = "#8a4fa3"


def overview(rows: Sequence[Row]) -> str:
    """HTML that needs nothing beside it but the reports that it links to."""
    environment = Environment(
        loader=FileSystemLoader(templates_folder()),
        undefined=StrictUndefined,
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    counts = verdicts(rows)
    text: str = environment.get_template("report/fleet.html.j2").render(
        total=len(rows),
        heading=f"Fleet of {len(rows)} unit{'' if len(rows) == 1 else 's'}",
        arms=len({row["arm"] for row in rows}),
        counts=[(key, WORDS[key], counts[key], COLOURS[key]) for key in WORDS if counts[key]],
        verdict_picture=_inline(verdict_bars(counts)),
        cause_picture=_inline(cause_bars(rows)) if causes(rows) else Markup(),
        gain_picture=_inline(gain_bars(rows)) if _gains(rows) else Markup(),
        rows=[_row(row) for row in rows],
        minutes=f"{sum(row.get('cpu_seconds') or 0.0 for row in rows) / 60:.3g}",
    )
    return "\n".join(line.rstrip() for line in text.splitlines()) + "\n"


def verdicts(rows: Sequence[Row]) -> Counter[str]:
    """How many units have which verdict; FAILED for those that have none."""
    return Counter(verdict(row) for row in rows)


def verdict(row: Row) -> str:
    """One of VERDICTS, or FAILED."""
    found = row.get("verdict")
    return found if found in VERDICTS else FAILED


def causes(rows: Sequence[Row]) -> Counter[tuple[str, int | None]]:
    """How often each cause is named, by effect and joint."""
    return Counter(
        pair for row in rows for pair in zip(row.get("causes") or (), row.get("joints") or (), strict=True)
    )


def verdict_bars(counts: Counter[str]) -> str:
    """Units by verdict, as SVG."""
    shown = [key for key in WORDS if counts[key]]
    made, axes = figure(1, 1, (5.2, 0.5 + 0.34 * len(shown)))
    axis = axes[0, 0]
    for k, key in enumerate(reversed(shown)):
        axis.barh(k, counts[key], color=COLOURS[key], height=0.7)
        axis.annotate(str(counts[key]), (counts[key], k), (4, 0), textcoords="offset points", va="center")
    axis.set_yticks(range(len(shown)), [WORDS[key] for key in reversed(shown)])
    _bare(axis, "units", max(counts.values()))
    return svg(made)


def cause_bars(rows: Sequence[Row]) -> str:
    """Named causes by effect, the joints in shades, as SVG."""
    found = causes(rows)
    effects = Counter[str]()
    for (effect, _), count in found.items():
        effects[effect] += count
    order = sorted(effects, key=lambda name: (effects[name], name))
    joints = sorted({joint for _, joint in found if joint is not None})
    places: list[int | None] = [*joints, *([None] if any(joint is None for _, joint in found) else [])]
    made, axes = figure(1, 1, (7.4, max(1.2, 0.2 + 0.2 * len(places), 0.7 + 0.27 * len(order))))
    axis = axes[0, 0]
    start = [0] * len(order)
    for place in places:
        widths = [found[effect, place] for effect in order]
        colour = _ARM if place is None else _JOINTS[min(joints.index(place), len(_JOINTS) - 1)]
        label = "whole arm" if place is None else f"joint {place}"
        axis.barh(range(len(order)), widths, left=start, color=colour, height=0.72, label=label)
        start = [a + b for a, b in zip(start, widths, strict=True)]
    for k, total in enumerate(start):
        axis.annotate(str(total), (total, k), (4, 0), textcoords="offset points", va="center")
    axis.set_yticks(range(len(order)), order)
    axis.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), fontsize=8)
    _bare(axis, "times named", max(start))
    return svg(made)


def _gains(rows: Sequence[Row]) -> list[float]:
    return [row["best_gain_percent"] for row in rows if row.get("best_gain_percent") is not None]


def gain_bars(rows: Sequence[Row]) -> str:
    """Histogram of what the named causes gain on the test records, as SVG."""
    gains = _gains(rows)
    made, axes = figure(1, 1, (5.2, 2.2))
    axes[0, 0].hist(gains, bins=range(0, 5 * (int(max(gains)) // 5) + 6, 5), color=COLOURS["named"])
    axes[0, 0].set_axisbelow(True)
    axes[0, 0].set_xlabel("less error on the test record, best joint [%]")
    axes[0, 0].set_ylabel("units")
    axes[0, 0].yaxis.get_major_locator().set_params(integer=True)
    return svg(made)


def _bare(axis: Any, label: str, most: int) -> None:
    axis.set_xlim(0, 1.12 * most)
    axis.set_xlabel(label)
    axis.xaxis.get_major_locator().set_params(integer=True)
    axis.grid(False, axis="y")
    axis.set_axisbelow(True)


def _row(row: Row) -> dict[str, Any]:
    found = verdict(row)
    fit, threshold = row.get("lack_of_fit"), row.get("lack_of_fit_threshold")
    named = zip(
        row.get("causes") or (), row.get("joints") or (), row.get("ambiguous_with") or (), strict=True
    )
    return {
        "unit": row["unit"],
        "report": row.get("report"),
        "unlinked": "" if row.get("report") else row["unit"],
        "arm": row["arm"] or "",
        "verdict": WORDS[found],
        "colour": COLOURS[found],
        "order": list(WORDS).index(found),
        "causes": [(e if j is None else f"{e} at joint {j}", ", ".join(rivals)) for e, j, rivals in named],
        "figures": [
            _number(max(row.get("delta_bic") or (), default=None), ".1f"),
            _number(row.get("best_gain_percent"), ".1f"),
            _number(None if fit is None else fit / threshold, ".2f"),
            _number(row.get("seconds"), ".1f"),
        ],
        "said": row.get("error") or row.get("reason") or "",
    }


def _number(value: float | None, form: str) -> tuple[str, str]:
    """Return the number as sorted and as shown."""
    return ("", "") if value is None else (f"{value:.9g}", f"{value:{form}}")


def _inline(text: str) -> Markup:
    """Cut a picture down to its svg element, which stands in the page as it is."""
    return Markup(text[text.index("<svg") :])
