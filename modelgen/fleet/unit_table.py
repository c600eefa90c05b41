"""The table of a fleet's units, a cell for each of its heads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import compress
from typing import Any, ClassVar

from modelgen.fleet.sentences import FAILED, titles, verdict
from modelgen.fleet.store import Row
from modelgen.report.page import Part, Run
from modelgen.report.parts import line
from modelgen.report.records import BEGINS, first_instant
from modelgen.report.words import listed

WORDS = {
    "named": "cause named",
    "suspected": "cause suspected",
    "nothing_missing": "nothing missing",
    "outside_catalogue": "outside the catalogue",
    "cannot_tell": "cannot tell",
    FAILED: "failed",
}
FIT = "lack of fit / threshold"
_LESS = "less error %"
_HEADS = ("unit", "arm", "verdict", "causes", "delta BIC", _LESS, FIT, "s", BEGINS, "reason")
_NUMBERS = ("verdict", "delta BIC", _LESS, FIT, "s")  # heads of columns that are sorted as numbers
HARM = "makes its test record worse"


@dataclass(frozen=True)
class Units(Part):
    """The table of all units, which can be sorted and filtered. rows: of cells by their heads."""

    kind: ClassVar[str] = "units"
    rows: Sequence[Sequence[Mapping[str, Any]]]

    def values(self) -> Mapping[str, Any]:
        """For the template, without columns that are empty."""
        filled = [any(row[k]["text"] or row[k]["causes"] for row in self.rows) for k in range(len(_HEADS))]
        heads = [{"text": head, "number": head in _NUMBERS} for head in compress(_HEADS, filled)]
        return {"heads": heads, "rows": [list(compress(row, filled)) for row in self.rows]}


def cells(row: Row) -> list[dict[str, Any]]:
    """A cell for each of the heads."""
    found = verdict(row)
    causes_ = titles(row)
    harms = row.get("harms") or [False] * len(causes_)
    sized = [f"{title}{_sized(row, k)}" for k, title in enumerate(causes_)]
    named = zip(sized, row.get("ambiguous_with") or (), harms, strict=True)
    figures = (
        (max(row.get("delta_bic") or (), default=None), "z.1f"),
        (row.get("overall_gain_percent") if row.get("causes") else None, "z.1f"),
        (None if row.get("lack_of_fit") is None else fit_over_threshold(row), ".2f"),
        (row.get("seconds"), ".1f"),
    )
    made = [
        _cell(line([linked(row)])),
        _cell(row["arm"] or ""),
        _cell(WORDS[found], sort=str(list(WORDS).index(found))),
        _cell(
            causes=[(title, ", ".join(rivals), f"✗ {HARM}" if harm else "") for title, rivals, harm in named],
        ),
        *(_cell(shown, "n", sort) for sort, shown in (_number(value, form) for value, form in figures)),
        _cell(first_instant(row.get("begins") or ())),
        _cell(row.get("error") or _more(row) or _failing(row) or row.get("reason") or "", "quiet"),
    ]
    return [{"head": head, **cell} for head, cell in zip(_HEADS, made, strict=True)]


def _sized(row: Row, k: int) -> str:
    """What was found of the k-th cause, with its deviations; empty where nothing of it has one."""
    place = (row["causes"][k], row["joints"][k])
    said = [
        f"{x['name']} {x['value']:.4g} ± {x['std']:.2g}{f' {unit}' if (unit := x['unit']) != '1' else ''}"
        for x in row.get("cause_parameters") or ()
        if (x["cause"], x["joint"]) == place and x["std"]
    ]
    return f": {listed(said)}" if said else ""


def _cell(
    text: str = "", look: str = "", sort: str | None = None, causes: Sequence[tuple[str, str, str]] = ()
) -> dict[str, Any]:
    """A cell of a unit. sort: what it is sorted by, None for its text; causes: with rivals and harm."""
    return {"text": text, "look": look, "sorted": sort is not None, "sort": sort, "causes": causes}


def fit_over_threshold(row: Row) -> float:
    """Lack of fit over its threshold; 0 where it was not measured."""
    fit, threshold = row.get("lack_of_fit"), row.get("lack_of_fit_threshold")
    return fit / threshold if fit is not None and threshold else 0.0


def linked(row: Row) -> Run:
    """The name of a unit, which leads to its report."""
    return Run(row["unit"], target=row.get("report") or "")


def _more(row: Row) -> str:
    """What is to be known beside causes that are named: worth, doubts and suspects; empty without one."""
    if not row.get("causes"):
        return ""
    suspects = _failing(row)
    also = [f"Suspected too: {suspects}."] if suspects else []
    return " ".join([*([row["worth"]] if row.get("worth") else []), *(row.get("doubts") or ()), *also])


def _failing(row: Row) -> str:
    """Suspects by the checks that they failed; empty where there are none."""
    groups: dict[str, list[str]] = {}
    for title, checks in zip(row.get("suspects") or (), row.get("failed_checks") or (), strict=False):
        groups.setdefault(listed(checks), []).append(title)
    return "; ".join(f"{listed(titles)} failed the check {checks}" for checks, titles in groups.items())


def _number(value: float | None, form: str) -> tuple[str, str]:
    """Return the number as sorted and as shown."""
    return ("", "") if value is None else (f"{value:z.9g}", f"{value:{form}}")
