"""The report of a refinement: motion before and after, parameters against start and description."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import compress
from typing import Any

import numpy as np

from modelgen.charts import Chart, Interval, apart, number, sheet
from modelgen.functions.nominal import known_base
from modelgen.identification.output_error.refine import Refined, Refinement
from modelgen.numeric import Array
from modelgen.report.call import Call
from modelgen.report.motion_figures import Motion, joined, motion_pair, small
from modelgen.report.page import (
    WIDE,
    Block,
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
from modelgen.report.refinement_steps import SAME, following, gained
from modelgen.report.words import listed

_FAR = 2.0  # standard deviations
_NAMED = 6  # parameters that moved, in a sentence
_KEEP = "The tuned values bring no joint nearer by 1 %: keep the values of the start."
_MEASURED = (
    "Goodness of fit 100 (1 - |y - simulated| / |y - mean y|), and RMSE of the positions, of whole parts "
    "simulated from their beginning, each from the initial states that suit its parameters best. The parts "
    "are those that were fitted: modelgen simulate --log says how well another motion is met."
)
_NO_INTERVALS = "It did not converge, and no value has an interval."


def motion(found: Refinement) -> list[Chart]:
    """Measured and simulated positions of every joint, part after part, and their difference."""
    arm = found.plant.arm
    t = _times(found)
    measured, started, refined = map(joined, (found.measured, found.started, found.simulated))
    models = ((started, "before", "simulated, at the start"), (refined, "after", "simulated, refined"))
    charts = []
    for j, name in enumerate(arm.coordinate_names):
        motions = [Motion(t, measured[:, j], path[:, j], role, label) for path, role, label in models]
        charts += motion_pair(name, arm.coordinate_units[j], motions, t[0], float(found.after.rmse[j]))
    return charts


def picture(found: Refinement) -> str:
    """SVG of `motion`."""
    return sheet(motion(found), 2)


def report(found: Refinement, call: Call) -> str:
    """HTML that needs nothing beside it."""
    arm = found.plant.arm
    name, names = arm.name, arm.coordinate_names
    rows = [
        (
            joint,
            *apart(found.before.f_gof[k], found.after.f_gof[k], 4),
            *(f"{x} {unit}" for x in (before, after)),
        )
        for k, (joint, (before, after, unit)) in enumerate(zip(names, misses(found), strict=True))
    ]
    heads = [("joint", "left"), ("F_gof % before", "right"), ("F_gof % after", "right")]
    heads += [("RMSE before", "right"), ("RMSE after", "right")]
    free = [x for x in found.parameters if not x.held]
    answers: Parts = [
        ("What was found", _ended(found, len(free))),
        (
            "How well it moves",
            [
                Folded("Simulated motion", [Grid("Simulated motion", heads, rows, folds=True)], narrow=True),
                Folded("How it is measured", [Text(_MEASURED, "quiet")], narrow=True),
            ],
        ),
        ("What moved", [Text(_moved(free, gained(found))), *_uncertain(found)]),
        (
            "What to do next",
            following(call, found),
        ),
    ]
    table = [
        (
            x.name,
            *apart(x.start, x.value, 5),
            deviation(x),
            "" if not x.std else f"{(x.value - x.start) / x.std:+z.1f}",
            x.unit,
            "" if not x.std else f"{_moving(found, x)} at {names[x.shown_by]}",
        )
        for x in found.parameters
    ]
    columns = [("parameter", "left"), ("start", "right"), ("refined", "right"), ("std", "right")]
    columns += [("moved by std", "right"), ("unit", "left"), ("std in the motion (RMS)", "left")]
    filled = [any(cells) for cells in zip(*table, strict=True)]
    shown = [tuple(compress(row, filled)) for row in table]
    sections: Parts = [
        ("Measured against simulated motion", [*_joined(found), block(motion(found))]),
        (
            "Parameters",
            [*_pictured(found), Grid("Parameters", list(compress(columns, filled)), shown, folds=True)],
        ),
        ("The logs", [records_table(found.records)]),
    ]
    return page(f"{name}: refined parameters", "Refinement", answers, sections)


def headline(found: Refinement) -> str:
    """How far the simulated motion is from the measured one, before and after, where it errs most."""
    arm, before, after = found.plant.arm, found.before.rmse, found.after.rmse
    span = [float(np.ptp(np.concatenate([q[:, j] for q in found.measured]))) for j in range(len(after))]
    worst = int(np.argmax(after / np.maximum(span, 1e-300)))
    old, new, unit = misses(found)[worst]
    where = f"at {arm.coordinate_names[worst]}" + (", where it errs most" if len(after) > 1 else "")
    worse = [arm.coordinate_names[j] for j in range(len(after)) if after[j] > SAME * before[j]]
    lost = f" It is farther from it than before at {listed(worse)}." if worse else ""
    text = f"The simulated motion misses the measured one by {new} {unit} (RMSE)"
    kept = "" if gained(found) or not found.converged else f" {_KEEP}"
    start = f"it was {old} {unit}" if old != new else "it was as much"
    return f"{text} {where}; with the values at the start {start}.{lost}{kept}"


def misses(found: Refinement) -> list[tuple[str, str, str]]:
    """RMSE of the positions before and after, in three digits, and their unit: by joint."""
    said = []
    for k, own in enumerate(found.plant.arm.coordinate_units):
        before, after = float(found.before.rmse[k]), float(found.after.rmse[k])
        size, unit = small(after, own)
        said.append((number(size * before), number(size * after), unit))
    return said


def deviation(x: Refined) -> str:
    """A parameter's standard deviation in words."""
    return "held" if x.held else "not known" if x.std is None else f"{x.std:z.2g}"


def _moving(found: Refinement, x: Refined) -> str:
    """What a parameter's deviation moves, in two digits, with its unit."""
    factor, unit = _sized(found, x)
    return f"{number(factor * x.moves, 2)} {unit}"


def _fine(value: float, unit: str) -> str:
    """A small value in two digits, with its unit."""
    size, said = small(value, unit)
    return f"{number(size * value, 2)} {said}"


def _ended(found: Refinement, free: int) -> list[Part | str]:
    """Whether the values are those of the best fit, and how many are."""
    tuned, steps = f"{free} of {len(found.parameters)} parameters", f"after {found.rounds} steps"
    if found.converged:
        text = f"{tuned} were tuned until no step brings the simulated motion nearer to the measured one"
        return [Text([Run(headline(found), "strong")]), Text(f"{text}: it converged {steps}.")]
    return [
        Text([Run(f"It did not converge {steps}: {found.stopped}.", "strong")]),
        Text(headline(found)),
        Text(_values(found, tuned)),
    ]


def _values(found: Refinement, tuned: str) -> str:
    """Whose the values of a refinement are that did not converge. tuned: how many of them."""
    if all(x.value == x.start for x in found.parameters):
        return (
            "All values are those of the start: no step brought the simulated motion nearer. Nothing says "
            "how far they are from the best fit."
        )
    return (
        f"The values of {tuned} are those of its last step, not of the best fit. Nothing says how far from "
        "that they are."
    )


def _moved(free: list[Any], gained: bool) -> str:
    """Which parameters left their start by more than their uncertainty."""
    far = sorted(
        (x for x in free if x.std and abs(x.value - x.start) > _FAR * x.std),
        key=lambda x: -abs(x.value - x.start) / x.std,
    )
    if all(x.std is None for x in free):
        return "How far any parameter is from its start says nothing: this is no best fit."
    if not far:
        more = "; what the motion gained is by all together" if gained else ""
        return f"No parameter left its start by more than {_FAR:g} standard deviations{more}."
    said = listed(f"{x.name} {' → '.join(apart(x.start, x.value))} {x.unit}".rstrip() for x in far[:_NAMED])
    more = f", and {len(far) - _NAMED} more" if len(far) > _NAMED else ""
    return f"By more than {_FAR:g} standard deviations: {said}{more}."


def _sized(found: Refinement, x: Refined) -> tuple[float, str]:
    """Factor and unit in which table and picture have what a parameter moves: fine where one needs it."""
    units = found.plant.arm.coordinate_units
    own = units[x.shown_by]
    return small(min(y.moves for y in found.parameters if y.std and units[y.shown_by] == own), own)


def _pictured(found: Refinement) -> list[Part]:
    """A picture of every unit of motion: what a parameter moved by, with its interval where one is known, and
    what the description has of it.
    """
    nominal = known_base(found.plant.model)
    free = [x for x in found.parameters if not x.held and np.isfinite(x.per_unit)]
    groups: dict[str, list[Interval]] = {}
    for x in free:
        factor, unit = _drawn(found, free, x)
        size, half = factor * x.per_unit, WIDE * factor * x.moves
        moved = size * (x.value - x.start)
        described = size * (nominal[x.name] - x.start) if x.name in nominal else None
        groups.setdefault(unit, []).append(Interval(x.name, moved, moved - half, moved + half, described))
    certain = any(x.std for x in free)
    ring = ", and a ring where the description has it" if any(x.name in nominal for x in free) else ""
    charts = [
        pictured(
            rows,
            f"change of the motion, RMS [{unit}]",
            f"What each parameter moved by, in the motion{', with its interval' if certain else ''}{ring}.",
            "" if len(groups) == 1 else f"parameters that show in {unit}",
        )
        for unit, rows in groups.items()
    ]
    said = (
        "How far each parameter went from its start, which is at zero, times what one unit of it moves the "
        f"motion by (RMS), where it shows most: a dot{' with its 95 % interval' if certain else ''}{ring}."
        f"{'' if certain else f' {_NO_INTERVALS}'}"
    )
    return [Text(said), Block(charts)] if charts else []


def _drawn(found: Refinement, free: Sequence[Refined], x: Refined) -> tuple[float, str]:
    """Factor and unit of a parameter in the picture: those of the table where deviations are known."""
    if x.std:
        return _sized(found, x)
    units = found.plant.arm.coordinate_units
    own = units[x.shown_by]
    moved = max(y.per_unit * abs(y.value - y.start) for y in free if units[y.shown_by] == own)
    return small(moved, own)


def _uncertain(found: Refinement) -> list[Part]:
    """The parameter whose uncertainty moves the motion most, beside the errors that are there anyway."""
    errors = found.after.rmse
    free = [x for x in found.parameters if x.std]
    if not free:
        return []
    worst = max(free, key=lambda x: x.moves / max(float(errors[x.shown_by]), 1e-300))
    arm = found.plant.arm
    unit, name = arm.coordinate_units[worst.shown_by], arm.coordinate_names[worst.shown_by]
    return [
        Text(
            f"Most uncertain, against the errors that remain, is {worst.name}: its deviation moves {name} by "
            f"{_fine(worst.moves, unit)} (RMS), beside an error of {_fine(errors[worst.shown_by], unit)}. "
            "Deviations count the errors of this motion; what the model lacks may move values by more."
        )
    ]


def _joined(found: Refinement) -> list[Part]:
    """Where the axis of the time has which part."""
    if len(found.t) < 2:
        return []
    ends = np.cumsum([t[-1] - t[0] for t in found.t])[:-1]
    text = f"{len(found.t)} parts of the records, one after the other"
    if len(ends) > 1 and np.ptp(np.diff(ends, prepend=0.0)) < 1e-3 * ends[0]:
        return [Text(f"{text}: the next one begins every {ends[0]:z.4g} s.")]
    seconds = [f"{end:z.4g} s" for end in ends[:_NAMED]]
    more = [f"{len(ends) - _NAMED} more"] if len(ends) > _NAMED else []
    return [Text(f"{text}: the next one begins at {listed([*seconds, *more])}.")]


def _times(found: Refinement) -> Array:
    """Times of all parts, one after the other, with one more where `joined` has a gap."""
    times, begin = [], 0.0
    for t in found.t:
        at = begin + t - t[0]
        begin = float(at[-1])
        times += [at, np.array([begin])]
    return np.concatenate(times)
