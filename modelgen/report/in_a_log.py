"""What an effect does to a log: records of a simulated arm, as the gallery of the documentation has them."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from typing import Any

from markupsafe import Markup

from modelgen.charts import chart_of
from modelgen.report.page import Block, Folded, Part, Text
from modelgen.report.words import listed
from modelgen.resources import gallery

PARTS = ("law", "residual")  # the pictures of an effect
LEAST = 0.005  # of the evidence, that is worth a number
_SIMULATED = (
    "These are other records: of a simulated arm, {arm}{encoder}, in which it was hidden. {said} The "
    "pictures are what the rest of the model leaves of the effort there, with the law, and the mean residual "
    "without and with it."
)


def in_a_log(effect: str) -> list[Part]:
    """A fold with its two pictures and what they show; none where the gallery is not at hand or lacks it."""
    found, line = gallery(), _records().get(effect)
    if found is None or line is None:
        return []
    folder, _ = found
    sheets = [(folder / f"{effect}-{part}.svg").read_text(encoding="utf-8") for part in PARTS]
    charts, legend = list[tuple[str, Markup]](), dict[tuple[str, str, bool], None]()
    for text in sheets:
        title, drawn, entries = chart_of(text)
        charts.append((title, Markup(drawn)))
        legend |= dict.fromkeys(entries)
    where = {"arm": line["arm"], "encoder": seen_by(line), "said": in_records(line)}
    parts: list[Part] = [Text(_SIMULATED.format(**where)), Block(charts, list(legend))]
    alike = [
        f"{other['effect']} {100 * other['share']:.0f} %"
        for other in line["lookalikes"]
        if other["share"] >= LEAST
    ]
    if alike:
        parts.append(Text(f"What look-alikes explain of its evidence there, in its place: {listed(alike)}."))
    return [Folded("What it does to a log", parts, printed=False)]


def in_records(line: Mapping[str, Any]) -> str:
    """What was found in records of the gallery, and how large it is there. line: of its records."""
    place, unit = line["place"], line["unit"]
    return (
        f"{line['found']} That is {line['size']} {unit} of the {line['whole']} {unit} (RMS) of {place}; with "
        f"it in the model the error there falls from {line['before']} to {line['after']} {unit} on a record "
        "that the fit has not seen."
    )


def seen_by(line: Mapping[str, Any]) -> str:
    """Where the encoders of records of the gallery sit, unless at the motors. line: of its records."""
    return "" if line["encoder"] == "motor" else ", with encoders at the joints"


@cache
def _records() -> Mapping[str, Mapping[str, Any]]:
    """What the records of the gallery showed, by effect."""
    found = gallery()
    lines = [] if found is None else found[1].read_text(encoding="utf-8").splitlines()
    return {line["effect"]: line for line in map(json.loads, lines)}
