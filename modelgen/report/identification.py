"""The report of an identification: one HTML file with its charts inside, and its pictures."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import compress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from modelgen.charts import Chart, Curve, Interval, in_percent, known, number, over_time, sheet
from modelgen.functions.nominal import known_base
from modelgen.identification import Identification, Validation
from modelgen.identification.beside_noise import noise_known
from modelgen.identification.summary import biased, determined, helpful, impossible, questions, remarks
from modelgen.identification.without_drives import Alternative
from modelgen.numeric import Array
from modelgen.options import words_of
from modelgen.report.arm_drawing import arm_drawing
from modelgen.report.call import WHERE, Call
from modelgen.report.noise import counted_as_noise, said_of_noise
from modelgen.report.page import WIDE, Block, Command, Folded, Grid, Lines, Run, Text, block, page, pictured
from modelgen.report.words import listed, sentence

FITTED = "the arm's model, fitted"
_EXPLAIN = "Answer the questions above first: no code should be generated from impossible values."
_UNBIASED = "which the errors of the positions do not bias; code should be generated from those values"
_EXPLAINED = "If the records are read rightly the model lacks something; this names the cause."
_RING = ", and a ring where the description has it"
_NOISE = "noise, between periods"
_QUESTIONS = 2  # that a phone has room for before the other answers
_POOR = "Poorly determined parameters"
_SHOWN = 5  # poorly determined parameters in full: more would leave the other answers no place
_LOOKS = ("s1", "s2", "s3")  # of models beside


def predictions(names: Sequence[str], found: Validation, others: Sequence[Alternative] = ()) -> list[Chart]:
    """Measured and predicted effort of every joint over time, and the residual.

    names: of the joints. others: models beside it. Test records follow each other on the time axis.
    """
    t, breaks = _elapsed(found.t)
    models = [(o.name, o.test, _LOOKS[k % len(_LOOKS)]) for k, o in enumerate(others)]
    models.append((FITTED if others else "predicted", found, "before"))
    charts = []
    for j, name in enumerate(names):
        unit = found.unit[j]
        left = [Curve(t, _cut(found.measured[:, j], breaks), "measured", "measured")]
        made = [(word, m.measured[:, j], _judged(m, j), look) for word, m, look in models]
        left += [Curve(t, _cut(x, breaks), look, word) for word, _, x, look in made]
        right = [Curve(t, _cut(y - x, breaks), look, word) for word, y, x, look in made]
        text = f"Effort of {name} over the test records, measured and predicted, with gaps where it rests."
        charts.append(over_time(name, f"effort [{unit}]", left, text, t[0], zoom=True))
        text = f"Residual of {name} over the test records."
        title, label = f"{name}, residual", f"residual [{unit}]"
        charts.append(over_time(title, label, right, text, t[0], zoom=True))
    return charts


def _judged(found: Validation, j: int) -> Array:
    """Predicted effort of joint j (M,), nan where it is not judged."""
    predicted = found.predicted[:, j]
    return predicted if found.judged is None else np.where(found.judged[:, j], predicted, np.nan)


def picture(found: Validation, names: Sequence[str], others: Sequence[Alternative] = ()) -> str:
    """SVG of `predictions`."""
    return sheet(predictions(names, found, others), 2)


def report(
    found: Identification,
    others: Sequence[Alternative],
    processing: Sequence[Any],
    spectra: Sequence[Chart],
    call: Call,
    speeds: Sequence[float],
) -> str:
    """HTML that needs nothing beside it. processing: parts on the logs. speeds: largest (n,) [per s]."""
    arm, test = found.arm, found.test
    names = arm.coordinate_names
    errors: list[Any] = [Text("There is no test record: nothing says how well the model predicts.")]
    if test is not None:
        heads = [("model", "left"), *((f"{n} [{u}]", "right") for n, u in zip(names, test.unit, strict=True))]
        share = listed(f"{x:z.1f} % at {n}" for x, n in zip(test.nrmse_percent, names, strict=True))
        title, cells = "Errors on the test records", [(t, *cells) for t, cells in models(test, others)]
        counted = counted_as_noise(test)
        errors = [
            Text(f"On records that it has not seen, the model misses {share} of the effort (NRMSE)."),
            Folded(title, [Grid(title, heads, cells, folds=True)], narrow=True),
            Text(f"RMSE, in brackets NRMSE in % of the effort. {counted}", "quiet"),
        ]
        if others:
            errors.append(Text("Below it: by how much the arm's model is below or above.", "quiet"))
    answers = [
        ("What was found", _found(found)),
        ("How well it predicts", errors),
        ("What is uncertain", _uncertain(found)),
        ("What to do next", following(found, call, speeds)),
    ]
    sections: list[tuple[str, Sequence[Any]]] = [("Parameters", [*_parameters(found), _method(found)])]
    if found.gains:
        heads = [("joint", "left"), *((h, "right") for h in ("described", "found", "std"))]
        rows = [
            (names[g.joint - 1], number(g.described, 5), known(g.value, g.std), f"{g.std:z.2g}")
            for g in found.gains
        ]
        sections.append(("Torque constants", [Grid("Torque constants", heads, rows)]))
    if test is not None:
        title = "Measured against predicted, the whole test records"
        rests = test.judged is not None and not test.judged.all()
        said = [Text("Gaps: the joint rests there, and its effort is whatever holds it; that is not judged.")]
        sections.append((title, [*(said if rests else []), block(predictions(names, test, others))]))
    shown = Folded("Spectra before and after the filters", [block(spectra)], printed=False, narrow=True)
    sections.append(("Processing of the logs", [*processing, shown]))
    drawing = Folded("The arm, to turn and move", [arm_drawing(arm)], screen=True)
    sections.append(("The arm", [drawing]))
    return page(f"{arm.name}: identified parameters", "Identification", answers, sections)


def _found(found: Identification) -> list[Any]:
    """What is impossible comes first, then how much is known, and below it what is doubtful or remarkable."""
    more = [*questions(found), *remarks(found)]
    first = [Text([Run(text, "strong")]) for text in impossible(found)]
    said: list[Any] = [Lines(more[:_QUESTIONS])] if more else []
    if more[_QUESTIONS:]:
        left = len(more) - _QUESTIONS
        title = f"{left} more question{'' if left == 1 else 's'} and remark{'' if left == 1 else 's'}"
        said.append(Folded(title, [Lines(more[_QUESTIONS:])], narrow=True))
    return [*first, Text(determined(found)), *said]


def _method(found: Identification) -> Text:
    condition = f"{found.solution.condition:z.4g}"
    return Text(
        f"Method {found.method}; condition number of the columns at unit length {condition}.", "quiet"
    )


def _uncertain(found: Identification) -> list[Any]:
    """What is poorly determined, in the effort that it stands for."""
    poor, test = found.poor(), found.test
    lost = [e.name for e in found.estimates if e.std is None and not e.dropped]
    parts: list[Any] = []
    if lost:
        parts.append(Text(f"Not determined by these records, set to zero: {', '.join(lost)}."))
    if poor and test is not None:
        rows = []
        for k, e in poor:
            j = test.shown_by(k)
            size, share = test.in_effort(k, e.std or 0.0)
            where = "" if j is None else found.arm.coordinate_names[j]
            unit = "" if j is None else test.unit[j]
            value = f"{number(e.value)} ± {number(e.std or 0.0, 2)} {e.unit}"
            rows.append((share, e.name, value, f"± {number(size, 2)} {unit}", f"{share:z.1f} % at {where}"))
        heads = [
            ("parameter", "left"),
            ("value", "right"),
            ("in effort", "right"),
            ("of the effort", "right"),
        ]
        rows.sort(key=lambda row: -row[0])
        table = [row[1:] for row in rows]
        parts += [
            Text("What the standard deviation of these parameters moves in the effort:"),
            Folded(_POOR, [Grid(_POOR, heads, table[:_SHOWN], folds=True)], narrow=True),
        ]
        if table[_SHOWN:]:
            more = Grid("Further poorly determined parameters", heads, table[_SHOWN:], folds=True)
            parts.append(Folded(f"And {len(table) - _SHOWN} more, that move less", [more], printed=False))
    parts += [Text(text) for text in helpful(found)]
    return parts or [Text("No parameter is uncertain by what would matter in the effort.")]


def following(found: Identification, call: Call, speeds: Sequence[float]) -> list[Any]:
    """The code, what the model lacks, a better motion."""
    name = found.arm.name
    described = call.beside(f"{name}_identified.yaml") if found.gains else None
    left_out = words_of(call.options, ("without",))
    scaled = words_of(call.options, ("gains",)) if not found.gains else []
    values = ["--parameters", call.beside(f"{name}_parameters.yaml")]
    generate = call.command("generate", *values, *left_out, *scaled, description=described)
    code = [
        Text(f"{call.first}{sentence(f'generate code with these values folded in, {WHERE}:')}"),
        Command(generate),
    ]
    wrong = bool(impossible(found))
    again = call.by_instruments(described) if found.method != "iv" and biased(found) else ""
    if again:
        code = [
            Text(f"{call.first}{sentence(f'fit again by instruments, {_UNBIASED}, {WHERE}:')}"),
            Command(again),
        ]
    parts: list[Any] = [Text(f"{call.first}{_EXPLAIN}")] if wrong else code
    diagnose = call.diagnosing()
    if found.test is not None and diagnose:
        far, said = said_of_noise(found)
        if far and not wrong:
            asis = [
                Text("For the values as they are: generate code with these folded in:"),
                Command(generate),
            ]
            parts = [Text(f"{call.first}{said}"), Command(diagnose), *(code if again else asis)]
        else:
            parts += [Text(_EXPLAINED if wrong else said), Command(diagnose)]
    excite = call.exciting(call.beside("trajectory.csv"), speeds)
    if found.poor() and excite:
        parts += [Text("A motion that determines the parameters better:"), Command(excite)]
    return parts


def _parameters(found: Identification) -> list[Any]:
    """A picture of every unit of effort, and the table."""
    nominal, parts = known_base(found.model), list[Any]()
    test = found.test
    if test is not None and test.sizes is not None:
        groups: dict[int, list[Interval]] = {}  # the joints of an arm may differ by much
        for k, e in enumerate(found.estimates):
            j = test.shown_by(k)
            if j is None or e.std is None:
                continue
            size, expected = float(test.sizes[j, k]), nominal.get(e.name)
            half = WIDE * e.std
            ends = (e.value - half) * size, (e.value + half) * size
            described = None if expected is None else expected * size
            groups.setdefault(j, []).append(Interval(e.name, e.value * size, *ends, described))
        charts = [
            pictured(
                rows,
                f"effort over the test record [{test.unit[j]}]",
                "Effort that each parameter stands for, with its interval and its nominal value.",
                "" if len(groups) == 1 else f"parameters that show at {found.arm.coordinate_names[j]}",
            )
            for j, rows in sorted(groups.items())
        ]
        parts += [
            Text(
                "Each parameter times the RMS of what one unit of it adds to the effort, where it shows "
                f"most: a dot with its 95 % interval{_RING if nominal else ''}."
            ),
            Block(charts),
        ]
    heads = [("parameter", "left"), *((h, "right") for h in ("value", "std", "nominal", "std %"))]
    heads += [("unit", "left"), ("essential", "left")]
    shown = [bool(nominal) or head != "nominal" for head, _ in heads]
    rows = [tuple(compress(_parameter(e, nominal.get(e.name)), shown)) for e in found.estimates]
    return [*parts, Grid("Parameters", list(compress(heads, shown)), rows)]


def _parameter(e: Any, nominal: float | None) -> tuple[str, ...]:
    std = "left out" if e.dropped else "not determined" if e.std is None else f"{e.std:z.2g}"
    share = "" if e.relative is None else in_percent(e.relative)
    described = "" if nominal is None else number(nominal, 5)
    return e.name, known(e.value, e.std), std, described, share, e.unit, "yes" if e.essential else "no"


def table(test: Validation) -> list[tuple[str, str]]:
    """RMSE and NRMSE in %, joint by joint."""
    return [(f"{a:z.4g}", f"{b:z.1f}") for a, b in zip(test.rmse, test.nrmse_percent, strict=True)]


def models(test: Validation, others: Sequence[Alternative]) -> list[tuple[str, list[str]]]:
    """RMSE and NRMSE in % by model, by how much the arm's own is below it in %, joint by joint; noise,
    where the records repeat.
    """
    rows = [(FITTED, [f"{a} ({b})" for a, b in table(test)])]
    for other in others:
        change = 100.0 * (test.rmse / np.maximum(other.test.rmse, 1e-300) - 1.0)
        cells = [f"{a} ({b}) {c:+z.0f}%" for (a, b), c in zip(table(other.test), change, strict=True)]
        rows.append((other.name, cells))
    noise = test.repeats
    if noise is not None and noise_known(test):
        rows.append((_NOISE, [f"{x:z.4g}" if np.isfinite(x) else "not known" for x in noise]))
    return rows


def _elapsed(t: Array) -> tuple[Array, NDArray[np.intp]]:
    """Time axis (M + breaks,) on which records follow each other, and where each one ends."""
    step = float(np.median(np.diff(t)))
    breaks = np.flatnonzero(np.abs(np.diff(t) - step) > 0.5 * step) + 1
    if not len(breaks):
        return t, breaks
    parts = np.split(t, breaks)
    axis, end = [], 0.0
    for part in parts:
        axis.append(part - part[0] + end)
        end = float(axis[-1][-1]) + step
    return _cut(np.concatenate(axis), breaks), breaks


def _cut(values: Array, breaks: NDArray[np.intp]) -> Array:
    """Put nan where a record ends, so that no line joins it with the next."""
    return np.insert(values, breaks, np.nan)
