"""A fleet on one page: how many of what, and every unit with the way to its report."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Any, ClassVar

from modelgen.fleet.sentences import FAILED, differences, titles, verdict
from modelgen.fleet.store import Row
from modelgen.fleet.unit_table import FIT, HARM, WORDS, Units, cells, fit_over_threshold, linked
from modelgen.report.page import Command, Lines, Part, Run, Text, page
from modelgen.report.parts import breaking
from modelgen.report.words import listed

_LOOKS = 7  # colours that are told apart
_URGENT = 8  # units that are listed first

_WIDEST = 80.0  # percent of the room, of a bar
_FAR = 2.0  # lack of fit over its threshold, from which on a unit with a named cause is to be looked at
_NOTHING = "Every unit could be diagnosed, and nothing is left unexplained."
_FAILED = (
    "Of units that failed: mend what the lines say, and call modelgen fleet again with --again. What is "
    "done, of the same files, is kept"
)
_LESS = "Less error: on the test record over all joints, with the causes than without. "
_REMAINS = "Lack of fit / threshold: above 1, something deterministic remains. "
_SORTS = "A click on a heading sorts."

Piece = tuple[str, int, str]  # word, count, look


def overview(rows: Sequence[Row], again: str = "") -> str:
    """HTML that needs nothing beside it but the reports that it links to. again: the command that makes what
    failed anew, empty where no file has the fleet.
    """
    counts, named, worth = verdicts(rows), cause_bars(rows), _worth(rows)
    found = [(WORDS[key], [(WORDS[key], counts[key], "k0")], counts[key]) for key in WORDS if counts[key]]
    said: list[Part] = [Text(_marked(text)) for text in differences(rows)]
    answers: list[tuple[str, list[Part]]] = [("What was found", [*said, Bars("Verdicts", "verdict", found)])]
    if named:
        answers.append(("What is missing", [Bars("Causes named, by joint", "cause", named)]))
        answers.append(("How sure", [Text(_sure(rows))]))
    if worth:
        answers.append(("What it is worth", [Text(worth)]))
    answers.append(("What to look at next", list(_next(rows, again))))
    minutes = sum(row.get("cpu_seconds") or 0.0 for row in rows) / 60
    time = f"s: by the clock, beside other units; {minutes:z.3g} min of processor time."
    units = [
        Units([cells(row) for row in rows]),
        Text(f"{_explained(rows)} {time}", "quiet"),
    ]
    arms = listed(f"{name}" for name in dict.fromkeys(row["arm"] for row in rows) if name)
    count = f"{len(rows)} unit{'' if len(rows) == 1 else 's'}"
    heading = f"{arms}: fleet of {count}" if arms else f"Fleet of {count}"
    return page(heading, "Diagnosis of many arms", answers, [("Units", units)], own="fleet")


@dataclass(frozen=True)
class Bars(Part):
    """Horizontal bars of counts. head: of their labels; rows: label, pieces and total of each."""

    kind: ClassVar[str] = "bars"
    caption: str
    head: str
    rows: Sequence[tuple[str, Sequence[Piece], int]]

    def values(self) -> Mapping[str, Any]:
        """For the template."""
        most = max((total for _, _, total in self.rows), default=1)
        bars = [
            {
                "label": breaking(label),
                "pieces": [
                    {"look": look, "width": f"{_WIDEST * count / most:z.4g}%", "text": f"{word}: {count}"}
                    for word, count, look in pieces
                ],
                "total": total,
                "said": _said(label, pieces),
            }
            for label, pieces, total in self.rows
        ]
        return {"caption": self.caption, "head": self.head, "bars": bars}


def _said(label: str, pieces: Sequence[Piece]) -> str:
    """What the pieces of a bar are, unless its label says so; of a single piece no count."""
    if len(pieces) > 1:
        return ", ".join(f"{word}: {count}" for word, count, _ in pieces)
    return "".join(word for word, _, _ in pieces if word != label)


def verdicts(rows: Sequence[Row]) -> Counter[str]:
    """How many units have which verdict; FAILED for those that have none."""
    return Counter(verdict(row) for row in rows)


def causes(rows: Sequence[Row]) -> Counter[tuple[str, int | None, str]]:
    """How often each cause is named, by effect, joint and its name, which is empty of the whole arm."""
    lists = ("causes", "joints", "joint_names")
    return Counter(
        (effect, joint, name or "")
        for row in rows
        for effect, joint, name in zip(*(row.get(key) or () for key in lists), strict=True)
    )


def cause_bars(rows: Sequence[Row]) -> list[tuple[str, list[Piece], int]]:
    """Named causes, the most frequent one first, each with its joints and how often in all."""
    found = causes(rows)
    effects = Counter[str]()
    for (effect, _, _), count in found.items():
        effects[effect] += count
    joints = sorted({(joint, name) for _, joint, name in found if joint is not None})
    bars = []
    for effect in sorted(effects, key=lambda name: (-effects[name], name)):
        parts = [
            (name, found[effect, joint, name], f"k{k % _LOOKS}")
            for k, (joint, name) in enumerate(joints)
            if found[effect, joint, name]
        ]
        if found[effect, None, ""]:
            parts.append(("whole arm", found[effect, None, ""], "k4"))
        bars.append((effect, parts, effects[effect]))
    return bars


def _explained(rows: Sequence[Row]) -> str:
    """What the columns of the table are, those that it has."""
    less = any(row.get("causes") and row.get("overall_gain_percent") is not None for row in rows)
    remains = any(row.get("lack_of_fit") is not None for row in rows)
    return f"{_LESS if less else ''}{_REMAINS if remains else ''}{_SORTS}"


def _marked(text: str) -> list[Run]:
    """A sentence whose names in backquotes are code."""
    return [Run(piece, "code" if k % 2 else "") for k, piece in enumerate(text.split("`")) if piece]


def _sure(rows: Sequence[Row]) -> str:
    """What the causes that are named have passed, with their evidence and how many have a rival."""
    named = [row for row in rows if row.get("causes")]
    count = sum(len(row["causes"]) for row in named)
    found = [x for row in named for x in row.get("delta_bic") or ()]
    rivals = sum(bool(others) for row in named for others in row.get("ambiguous_with") or ())
    said = "The cause" if count == 1 else f"Each of the {count} causes"
    said += " passed every check that decides"
    if found:
        low, high = f"{min(found):z.0f}", f"{max(found):z.0f}"
        said += f"; evidence (delta BIC) {low if low == high else f'{low} to {high}'}"
    if not rivals:
        return f"{said}; {'it has no' if count == 1 else 'none has a'} rival."
    return (
        f"{said}. {rivals} of {count} {'has' if rivals == 1 else 'have'} a rival: in the table, behind “or”."
    )


def _worth(rows: Sequence[Row]) -> str:
    """What naming causes is worth on the test records, over the units that have one."""
    named = [row.get("overall_gain_percent") for row in rows if row.get("causes")]
    gains = [gain for gain in named if gain is not None]
    if not gains:
        return ""
    alone = [row["worth"] for row in rows if row.get("worth")]
    if len(alone) == len(gains) == 1:
        return str(alone[0])
    worse = sum(g < 0.0 for g in gains)
    middle = median(gains)
    way = "less" if middle >= 0.0 else "larger"
    said = f"With the causes the error on the test records is {abs(middle):z.1f} % {way} over all joints"
    low, high = f"{min(gains):z.1f}", f"{max(gains):z.1f}"
    if low != high:
        said += f" (median of {len(gains)} units, {low} to {high} %)"
    elif len(gains) > 1:
        said += f" in each of {len(gains)} units"
    said += f"; it is larger in {worse}." if worse else "."
    harmed = sum(any(row.get("harms") or ()) for row in rows)
    if not harmed:
        return said
    units = "In one unit" if harmed == 1 else f"In {harmed} units"
    return f"{said} {units} a cause {HARM}, though all together may make it better."


def _open(rows: Sequence[Row]) -> list[Row]:
    """Units that failed or were left unexplained, the most urgent first."""
    ends = [FAILED, "outside_catalogue", "suspected", "cannot_tell"]
    return sorted((r for r in rows if verdict(r) in ends), key=lambda row: ends.index(verdict(row)))


def _urgent(rows: Sequence[Row]) -> Iterator[list[Run]]:
    """Units that failed or were left unexplained, or of which a cause harms the test record, each with its
    report.
    """
    lines = []
    for row in _open(rows):
        error = row.get("error")
        lines.append([linked(row), Run(f": {WORDS[verdict(row)]}{f', {error}' if error else ''}")])
    for row in rows:
        worse = _harming(row)
        if worse:
            lines.append([linked(row), Run(f": {listed(worse)} {HARM}; its page has the model without")])
        elif doubts := row.get("doubts"):
            lines.append([linked(row), Run(f": {' '.join(doubts)}")])
        elif row.get("causes") and fit_over_threshold(row) > _FAR:
            remains = (
                f"something deterministic remains beside what is named, {FIT} {fit_over_threshold(row):.3g}"
            )
            lines.append([linked(row), Run(f": {remains}")])
    yield from lines[:_URGENT]
    if len(lines) > _URGENT:
        yield [Run(f"{len(lines) - _URGENT} more: see the table")]


def _harming(row: Row) -> list[str]:
    """Causes that make the test record of a unit worse."""
    return [title for title, harm in zip(titles(row), row.get("harms") or (), strict=False) if harm]


def _next(rows: Sequence[Row], again: str) -> Iterator[Part]:
    """The units to look at, and the command for the first of them that has one."""
    urgent = list(_urgent(rows))
    yield Lines(urgent) if urgent else Text(_NOTHING)
    yield from first_step(rows, again)
    if sum(bool(row.get("command")) for row in rows) > 1:
        yield Text("The pages of the others have theirs.", "quiet")


def first_step(rows: Sequence[Row], again: str) -> Iterator[Part]:
    """What is to be done first, with its command. again: as of `overview`."""
    if any(verdict(row) == FAILED for row in rows):
        yield Text(f"{_FAILED}{':' if again else '.'}")
        if again:
            yield Command(again)
    wanting = _open(rows) + [row for row in rows if _harming(row)]
    lacking = [row for row in rows if row.get("causes")]
    first = next((row for row in [*wanting, *lacking, *rows] if row.get("command")), None)
    if first is not None:
        text = first["next"]
        yield Text([Run("For "), linked(first), Run(f": {text[:1].lower()}{text[1:]}")])
        yield Command(first["command"])
