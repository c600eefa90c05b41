"""The report of a calibration: the lever as described and as found, and the angles that it explains."""

from __future__ import annotations

import numpy as np

from modelgen.calibration import Calibration, Estimate
from modelgen.charts import Chart, Curve, Interval, apart, number, sheet
from modelgen.description import Arm
from modelgen.numeric import Array
from modelgen.report.call import WHERE, Call
from modelgen.report.page import (
    WIDE,
    Block,
    Command,
    Folded,
    Grid,
    Part,
    Parts,
    Run,
    Text,
    block,
    page,
    pictured,
)
from modelgen.report.records import records_table
from modelgen.report.words import joint_name, listed, sentence

_FAR = 2.0  # standard deviations
_BEFORE, _AFTER = "as described", "calibrated"
_SAID = {"m": (1e3, "mm"), "rad": (float(np.degrees(1.0)), "deg")}  # factor and unit in which values are said
_MUCH = 0.5  # of the error, from which on what a constant offset alone explains is worth a sentence
_MEANT = (
    "l1 and l2 are the distances of the actuator's two ends from the joint's axis, qp_min and qp_max its "
    "lengths at the ends of the motor's range, offset the joint's angle beyond that of this triangle. Moved "
    "by std: how far a value is from the description, in its standard deviations (std)."
)


def charts(arm: Arm, c: Calibration) -> list[Chart]:
    """Measured angle and both levers over the motor coordinate, and what each misses."""
    name = joint_name(arm, c.joint)
    order = np.argsort(c.motor, kind="stable")
    x, measured = c.motor[order], np.degrees(c.measured[order])
    before, after = (np.degrees(lever.angle(x)) for lever in (c.before, c.after))
    label = f"motor of {name} [motor unit]"
    return [
        Chart(
            f"{name}: angle",
            label,
            "angle [deg]",
            [
                Curve(x, measured, "measured", "measured", True),
                Curve(x, before, "before", _BEFORE),
                Curve(x, after, "after", _AFTER),
            ],
            f"Angle of {name} over its motor coordinate, measured and of both levers.",
        ),
        Chart(
            f"{name}: error",
            label,
            "error [deg]",
            [
                Curve(x, measured - before, "before", f"error {_BEFORE}", True),
                Curve(x, measured - after, "after", f"error {_AFTER}", True),
            ],
            f"Measured angle of {name} less that of either lever.",
        ),
    ]


def picture(arm: Arm, c: Calibration) -> str:
    """SVG of `charts`."""
    return sheet(charts(arm, c), 2)


def report(arm: Arm, c: Calibration, call: Call) -> str:
    """HTML that needs nothing beside it."""
    name = joint_name(arm, c.joint)
    before, after = errors(c)
    said = f"The lever of {name} explains the angle to {after} deg instead of {before} deg (RMSE): "
    said += f"{c.improvement_percent:z.0f} % less, over {len(c.motor)} samples. {verdict(c)}"
    branch = [Text(text) for text in beside(c)]
    weak = [Text(f"Not determined: {words}.") for words in c.weak]
    heads = [("value", "left"), *((h, "right") for h in ("described", "calibrated", "std", "moved by std"))]
    heads.append(("unit", "left"))
    steps = (f"{(e.value - e.before) / e.std:+z.1f}" if e.std > 0 else "" for e in c.estimates)
    rows = [(*row[:-1], step, row[-1]) for row, step in zip(values(c), steps, strict=True)]
    table = Grid("Lever as described and calibrated", heads, rows, folds=True)
    answers: Parts = [
        ("What was found", [Text(said), *branch]),
        (
            "Described and calibrated",
            [Folded(f"All {len(rows)} values", [table, Text(_MEANT, "quiet")], narrow=True)],
        ),
        ("What is uncertain", [Text(_meant(c)), Text(_uncertain(c)), *weak]),
        (
            "What to do next",
            following(call, stands(c)),
        ),
    ]
    sections: Parts = [
        ("Values", _pictured(c)),
        ("Measured angles and both levers", [block(charts(arm, c))]),
        *([("The log", [records_table([c.record])])] if c.record else []),
    ]
    return page(f"{arm.name}: lever of {name}", "Calibration", answers, sections)


def errors(c: Calibration) -> tuple[str, str]:
    """RMSE of the angle with the lever as described and as found [deg]."""
    return apart(float(np.degrees(c.rms_before)), float(np.degrees(c.rms_after)))


def beside(c: Calibration) -> list[str]:
    """What else would explain the angle: the other branch, a constant offset alone where that does much."""
    said = []
    if c.after.rev != c.before.rev:
        left = number(float(np.degrees(c.candidates[c.before.rev])))
        said.append(f"rev is {c.after.rev:+d}: the other branch leaves {left} deg.")
    if c.rms_shifted < _MUCH * c.rms_before:
        left = number(float(np.degrees(c.rms_shifted)))
        said.append(f"A constant offset of the angle alone, with the lever as described, leaves {left} deg.")
    return said


def values(c: Calibration) -> list[list[str]]:
    """Name, described, calibrated, standard deviation and unit of every value."""
    return [
        [e.name, *apart(size * e.before, size * e.value, 5), number(size * e.std, 2), unit]
        for e, size, unit in _sized(c)
    ]


def stands(c: Calibration) -> bool:
    """Whether the lever as described agrees with the angles: its branch, every value, and all together."""
    return c.agrees and not _moved(c)


def verdict(c: Calibration) -> str:
    """What differs from the description, in words."""
    if stands(c):
        return f"The description stands: no value differs from it by more than {_FAR:g} standard deviations."
    moved = listed(
        f"{e.name} is {number(size * e.value, 4)} {unit}, not {number(size * e.before, 4)}"
        for e, size, unit in _moved(c)
    )
    if moved:
        return f"Differs by more than {_FAR:g} standard deviations: {moved}."
    if c.after.rev != c.before.rev:
        return "The branch differs."
    return (
        f"No value alone differs by more than {_FAR:g} standard deviations, for the angles do not tell one "
        "from another; together they are not those described."
    )


def _moved(c: Calibration) -> list[tuple[Estimate, float, str]]:
    """Estimates that differ clearly from the description, as `_sized`."""
    return [x for x in _sized(c) if abs(x[0].value - x[0].before) > _FAR * x[0].std]


def _sized(c: Calibration) -> list[tuple[Estimate, float, str]]:
    """Estimates with the factor and the unit in which they are said: lengths in mm, angles in deg."""
    return [(e, *_SAID.get(e.unit, (1.0, e.unit))) for e in c.estimates]


def _uncertain(c: Calibration) -> str:
    """Every value's interval in its unit."""
    said = listed(f"{e.name} ± {number(WIDE * size * e.std, 2)} {unit}" for e, size, unit in _sized(c))
    more = "" if c.weak else " The angles and the measured lengths determine every value."
    return f"95 % intervals: {said}.{more}"


def _meant(c: Calibration) -> str:
    """What the values' uncertainty, all together, makes of the angle and of the effort over the record."""
    angle, effort = WIDE * np.degrees(c.angle_std), 100.0 * WIDE * c.effort_std
    at = number(float(c.motor[int(np.argmax(effort))]), 3)
    (a, most_a), (e, most_e) = ((number(_rms(x), 2), number(float(x.max()), 2)) for x in (angle, effort))
    return (
        f"Over this record the values together give the angle to {a} deg (95 %, RMS; {most_a} at worst), and "
        f"the joint's effort per current to {e} % ({most_e} % at worst, where the motor is at {at})."
    )


def _rms(x: Array) -> float:
    return float(np.sqrt(np.mean(x**2)))


def _pictured(c: Calibration) -> list[Part | str]:
    """A picture of every unit: what a value moved by, with its interval, beside the description."""
    groups: dict[str, list[Interval]] = {}
    for e, size, unit in _sized(c):
        moved, half = size * (e.value - e.before), WIDE * size * e.std
        groups.setdefault(unit, []).append(Interval(e.name, moved, moved - half, moved + half, 0.0))
    said = "How far each value is from the description: a dot with its 95 % interval, a ring as described."
    words = "How far each value is from the description, with its interval."
    return [
        Text(said),
        Block([pictured(rows, f"found less described [{unit}]", words) for unit, rows in groups.items()]),
    ]


def following(call: Call, stands: bool) -> list[Part | str]:
    """The description, with this lever where it differs, in what follows: a motion, then the parameters."""
    described, first = None, [Run("Keep the description: ")]
    if not stands:
        described = call.beside(f"{call.arm.name}_calibrated.yaml")
        first = [Run(described, "code"), Run(" is the description with this lever: ")]
    used = [
        *first,
        Run("modelgen identify", "code"),
        Run(" finds the parameters with it, from records of a motion that determines them."),
    ]
    excite = call.exciting(call.beside("trajectory.csv"), description=described)
    if not excite:
        return [Text(used)]
    return [Text(used), Text(sentence(f"this computes such a motion, {WHERE}:")), Command(excite)]
