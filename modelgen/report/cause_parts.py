"""What the page of a diagnosis says of one cause or suspect."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.charts import number
from modelgen.diagnosis.extended import NamedCause
from modelgen.diagnosis.result import Diagnosis
from modelgen.diagnosis.validation import Check
from modelgen.effects import CATALOGUE
from modelgen.model.parameters import units_at
from modelgen.report.diagnosis_sentences import cause_title, checked, interval
from modelgen.report.in_a_log import in_a_log
from modelgen.report.law_figures import judged_joint, law_charts, law_size, seen
from modelgen.report.law_sketch import sketch
from modelgen.report.page import Folded, Grid, Heading, Marks, Part, Run, Section, Text, block
from modelgen.report.words import law, legible, sentence, value_said

_LOOKALIKES = (("confused with", "left"), ("what that is", "left"), ("seen by itself in", "left"))
_DEFINED = (("parameter", "left"), ("unit", "left"), ("meaning", "left"))
_VALUES = (("parameter", "left"), ("value", "right"), ("std", "right"), ("unit", "left"), ("meaning", "left"))


def marks(c: NamedCause, key: str) -> Marks:
    """Its checks."""
    return Marks(key, [_mark(check) for check in c.checks])


def failed(d: Diagnosis, c: NamedCause) -> str:
    """The checks that keep it from its name."""
    lost = [x for x in c.checks if x.decides and x.passed is False]
    return "; ".join(f"{x.name} ({x.text})" for x in lost)


def law_found(d: Diagnosis, k: int) -> Section:
    """The law of cause k over the data, with its values and its evidence."""
    c = d.causes[k]
    reference = Run(f"{CATALOGUE[c.effect].reference}.", "quiet")
    text = [Run(f"{_law(c.effect)} "), reference, Run(" "), _more(c)]
    charts = law_charts(d, k)
    parts: list[Part] = [Text(text), Text(f"{_size(d, k)}{seen(charts)}"), block(charts), _values(d, c)]
    evidence = (
        f"Evidence: delta BIC {c.delta_bic:z.1f}; {c.cross_gain:z.1f} % less error on training records that "
        f"its fit had not seen, {c.expected_gain:z.1f} % expected there{_share(c)}."
    )
    return Section(f"The law found: {cause_title(d, c)}", [*parts, Text(evidence)], f"cause{k}")


def suspected(d: Diagnosis, k: int) -> list[Part]:
    """Suspect k, with its values and what keeps it from its name."""
    c = d.suspects[k]
    evidence = f"Evidence: delta BIC {c.delta_bic:z.1f}. It is not named: {failed(d, c)}."
    return [
        Heading(cause_title(d, c), f"suspect{k}"),
        Text([Run(f"{_law(c.effect)} "), _more(c)]),
        Text(evidence),
        _values(d, c),
    ]


def about(d: Diagnosis) -> list[Section]:
    """Every effect that is named or suspected: its law as a sketch, and what resembles it."""
    places: dict[str, list[int | None]] = {}
    for c in (*d.causes, *d.suspects):
        places.setdefault(c.effect, []).append(c.joint)
    return [
        Section(f"About {effect}", _about(d, effect, joints), f"about-{effect}")
        for effect, joints in places.items()
    ]


def _about(d: Diagnosis, effect: str, joints: Sequence[int | None]) -> list[Part]:
    """What the documentation says of it, as far as it stands on its own."""
    definition = CATALOGUE[effect]
    parts: list[Part] = [
        Text(_law(effect)),
        block([sketch(effect)]),
        Text("The picture is of an example.", "quiet"),
        Text(f"Seen by itself in: {sentence(definition.experiment)} Reference: {definition.reference}."),
    ]
    if definition.confused_with:
        rows = [
            (other, CATALOGUE[other].text, CATALOGUE[other].experiment) for other in definition.confused_with
        ]
        parts.append(Grid(f"What {effect} is confused with", _LOOKALIKES, rows, folds=True))
    units = [units_at(d.arm, effect, joint) for joint in joints]
    values = [
        (p.name, " or ".join(dict.fromkeys(u[p.name] for u in units)), p.text) for p in definition.accepted()
    ]
    defined = Grid(f"Parameters of {effect}", _DEFINED, values, folds=True)
    parts += [
        *in_a_log(effect),
        Folded(f"Parameters of {effect}", [defined], printed=False),
        Text([Run("All effects: "), Run("modelgen effects", "code")], "quiet"),
    ]
    return parts


def _law(effect: str) -> str:
    stated = law(effect)
    return f"{sentence(CATALOGUE[effect].text)}{f' Law: {stated}' if stated else ''}"


def _more(c: NamedCause) -> Run:
    """A link to what the page says of an effect."""
    return Run("More about it, and what it does to a log", target=f"#about-{c.effect}")


def _size(d: Diagnosis, k: int) -> str:
    size = law_size(d, k)
    if size is None:
        return ""
    where = d.arm.coordinate_names[judged_joint(d, k)]
    own, whole = number(size[0], 2), number(size[1], 2)
    if size[0] > size[1]:
        return (
            f"Its size on the test record is {own} {size[2]} (RMS), more than the effort of {where} itself, "
            f"{whole} {size[2]}: other parameters of the model act against it. "
        )
    sizes = f"{own} of the {whole} {size[2]}"
    return f"Its size on the test record: {sizes} of {where} (RMS). "


def _values(d: Diagnosis, c: NamedCause) -> Grid:
    meanings = {p.name: p.text for p in CATALOGUE[c.effect].accepted()}
    rows: Sequence[Sequence[str]] = [
        (
            name,
            value_said(d.arm, c.effect, name, e, unit=False),
            "" if np.isnan(e.std) else f"{e.std:z.2g}",
            e.unit,
            meanings.get(name, ""),
        )
        for name, e in legible(c.parameters).items()
    ]
    return Grid(f"Values of {cause_title(d, c)}", _VALUES, rows, folds=True)


def _mark(c: Check) -> tuple[str, str, str]:
    """Class, name and figures of a check."""
    name, _, text = checked(c)
    kind = "unasked" if c.passed is None else "yes" if c.passed else "no"
    return kind, name, text if c.decides else f"{text}; reported, decides nothing"


def _share(c: NamedCause) -> str:
    """Effect of the cause on the error of the test record; empty where it is not known."""
    s = c.share
    if np.isnan(s.gain):
        return ""
    size, low, high, word = (
        (s.gain, s.low, s.high, "less") if s.gain >= 0 else (-s.gain, -s.high, -s.low, "more")
    )
    return f"; {size:z.1f} % {word} error on the test record than without it" + interval(low, high, " ({} %)")
