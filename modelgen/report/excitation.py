"""The report of an excitation: the motion on both sides of the drives, how well it excites, limits used."""

from __future__ import annotations

import numpy as np

from modelgen.charts import Chart, Curve, number, over_time, sheet
from modelgen.dataset.drives import drives_of
from modelgen.excitation import NOISE, Excitation, determined
from modelgen.excitation.writing import WORST
from modelgen.functions import EVALUATED, build_model
from modelgen.identification.objects import MATTERS, Estimate
from modelgen.identification.summary import experiment
from modelgen.options import ExcitationOptions, options_of, words_of
from modelgen.report.call import WHERE, Call
from modelgen.report.page import Command, Grid, Lines, Part, Parts, Text, block, page
from modelgen.report.words import limit_name, listed

_GOOD, _FAIR = (
    30.0,
    100.0,
)  # condition numbers with columns of unit norm (Schroeer 1993; Gautier and Khalil 1992)
_UNKNOWN = (
    "with the same noise at all joints, for the description has no nominal inertials and effects that say "
    "how large their efforts are"
)
_BETTER = "more --starts and --harmonics look for such a motion, wider limits make room for it."
_STILL = 0.01  # of a joint's largest speed, that no controller notices at the begin
_SECOND = "_test"  # what the name of the second motion ends in
_ELSEWHERE = ("processes", "dask")  # options that say where the work is done
_SIDES = (
    ("q", "position", "", "joint"),
    ("dq", "speed", "/s", "joint"),
    ("qm", "motor", "", "motor"),
    ("dqm", "motor speed", "/s", "motor"),
)


def charts(e: Excitation) -> list[Chart]:
    """Position and speed on both sides of every drive over one period."""
    drives, found = drives_of(e.arm), []
    for k, name in enumerate(e.arm.coordinate_names):
        angle = e.arm.joints[e.arm.coordinates[k]].type != "prismatic"
        own = "deg" if angle else "m"
        units = {"joint": own, "motor": drives[k].unit if drives[k].driven else own}
        for signal, word, per, side in _SIDES:
            unit = {"unit": "motor unit"}.get(units[side], units[side])
            y = e.signals[signal][:, k]
            y = np.degrees(y) if unit == "deg" else y
            found.append(
                over_time(
                    f"{name}, {word}",
                    f"{word} [{unit}{per}]",
                    [Curve(e.t, y, "before" if side == "joint" else "after", f"{side} side")],
                    f"{word.capitalize()} of {name} over one period.",
                    e.t[0],
                    zoom=True,
                )
            )
    return found


def picture(e: Excitation) -> str:
    """SVG of `charts`."""
    return sheet(charts(e), len(_SIDES))


def report(e: Excitation, stem: str, call: Call) -> str:
    """HTML that needs nothing beside it. stem: what the names of the files beside it begin with."""
    s = e.problem.settings
    remarks = [*e.arm.notes, *e.problem.remarks]
    tight = sorted(e.usage.items(), key=lambda item: -item[1])
    rows = [(limit_name(e.arm, limit), f"{100 * share:z.1f}") for limit, share in tight]
    answers: Parts = [
        ("What was found", [Text(separates(e))]),
        ("What it determines worst", [Text(text) for text in worst(e)]),
        (
            "What it asks of the arm",
            [
                Text(
                    f"One period of {s.period:g} s, {s.rate:g} set-points a second, {s.harmonics} harmonics. "
                    "The last row of the file is the first one again, a period later: a loop leaves it out."
                ),
                *(
                    [Text(f"Tightest limit: {rows[0][0]}, {100 * tight[0][1]:z.0f} % of it used.")]
                    if tight
                    else []
                ),
                *_begin(e),
                *([Lines(remarks)] if remarks else []),
            ],
        ),
        ("What to do next", following(e, stem, call)),
    ]
    sections: Parts = [
        ("The motion", [block(charts(e))]),
        ("Limits", [Grid("Limits", [("limit", "left"), ("used %", "right")], rows, long=True)]),
    ]
    return page(f"{e.arm.name}: excitation trajectory", "Excitation", answers, sections)


def _begin(e: Excitation) -> list[Part | str]:
    """Where the motion begins, and how fast."""
    parts = zip(
        e.arm.coordinate_names, e.arm.coordinate_units, e.signals["q"][0], e.signals["dq"][0], strict=True
    )
    first, moving = [], False
    for k, (name, unit, q, dq) in enumerate(parts):
        size, own = (1.0, unit) if unit == "m" else (180.0 / np.pi, "deg")
        fast = abs(dq) > _STILL * np.abs(e.signals["dq"][:, k]).max()
        moving |= bool(fast)
        first.append(
            f"{name} {number(size * q)} {own}" + (f" at {number(size * dq)} {own}/s" if fast else "")
        )
    text = f"It begins at {listed(first)}."
    if not moving:
        return [Text(f"{text} Bring the arm there first.")]
    return [
        Text(
            f"{text} Bring the arm there first; it jumps to that speed. With --rest a motion begins at rest."
        )
    ]


def separates(e: Excitation) -> str:
    """How well the motion tells the base parameters apart, by its condition number."""
    grade = "well" if e.condition <= _GOOD else "fairly" if e.condition <= _FAIR else "badly"
    said = (
        f"The motion separates the {len(e.problem.names)} base parameters {grade}: condition number "
        f"{number(e.condition)} with columns of unit norm ({_GOOD:g} is good, above {_FAIR:g} is poor)."
    )
    reached = [x for x in e.values if np.isfinite(x)]
    if len(reached) > 1:
        said += f" {len(reached)} starts ended between {number(min(reached))} and {number(max(reached))}."
    return said


def worst(e: Excitation) -> list[str]:
    """Which parameters a period determines worst, in the unit of the inputs, and what to change."""
    names, found = e.arm.coordinate_names, determined(e)[:WORST]
    units = [
        "A" if drive.driven else "N" if unit == "m" else "N m"
        for drive, unit in zip(drives_of(e.arm), e.arm.coordinate_units, strict=True)
    ]
    first, noise = found[0], f"with noise of {100 * NOISE:g} % of its joint's effort in every sample"
    if first.share is None:
        noise = _UNKNOWN
        said = listed(f"{d.name} ({number(d.size, 2)} of the noise, at {names[d.joint]})" for d in found)
    else:
        said = listed(
            f"{d.name} ({number(d.size, 2)} {units[d.joint]}, {number(d.share or 0.0, 2)} % of the effort of "
            f"{names[d.joint]})"
            for d in found
        )
    text = f"Most uncertain, by the effort that it stands for: {said}, after one period {noise}."
    periods = max(d.periods(MATTERS) for d in found)
    if periods <= 1:
        matter = "would matter in the effort" if first.share is not None else "a single sample has of noise"
        return [text, f"Nothing has to be changed: no parameter is uncertain by what {matter}."]
    model = build_model(e.arm, EVALUATED)
    base = {b.name: model.standard[b.representative].name for b in model.grouping.base}
    wanting = [
        Estimate(d.name, 0.0, None, "", False, joint=d.joint + 1, standard=base[d.name])
        for d in found
        if d.periods(MATTERS) > 1
    ]
    limit = f"{MATTERS:g} % of the effort" if first.share is not None else "that noise"
    advice = "; ".join(experiment(wanting, names))
    return [
        text,
        f"Record {periods} periods in a row to have them within {limit}, or let the motion show them better "
        f"({advice}): {_BETTER}",
    ]


def following(e: Excitation, stem: str, call: Call) -> list[Part | str]:
    """Two records of two motions, and what makes parameters of them.

    A stem that ends in `_test` is that of the second motion, whose record is the test record.
    """
    second = stem.endswith(_SECOND) and stem != _SECOND
    first = stem.removesuffix(_SECOND) if second else stem
    train, test = (call.beside(f"{first}{word}_record.csv") for word in ("", _SECOND))
    run = (
        f"Give {stem}_set_points.csv to the position controller, three or more periods in a row, and record "
    )
    records = ["--train", train, "--test", test, "--out", call.beside("identified")]
    fit = Command(call.command("identify", *records))
    if second:
        said = f"positions and efforts as {test}: the test record, where that of the first motion is {train}."
        return [Text(f"{call.first}{run}{said} With both records, the parameters, {WHERE}:"), fit]
    names = [name for name in options_of(ExcitationOptions) if name not in (*_ELSEWHERE, "seed")]
    again = words_of(e.problem.settings, names)
    seed = str(e.problem.settings.seed + 1)
    other = call.command("excite", *again, "--seed", seed, "--out", call.beside(f"{stem}{_SECOND}.csv"))
    return [
        Text(
            f"{call.first}{run}positions and efforts as {train}. The test record, {test}, is of another "
            f"motion, which this computes, {WHERE}; its page says how it is recorded:"
        ),
        Command(other),
        Text("With both records, the parameters:"),
        fit,
    ]
