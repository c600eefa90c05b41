"""The next experiment in the report, and its files: the trajectory, its set-points, a picture."""

from __future__ import annotations

import re

import numpy as np

from modelgen.charts import Band, Chart, Curve, over_time, sheet
from modelgen.description import Arm
from modelgen.diagnosis.experiment import STEM, Experiment, Proposal, differences
from modelgen.diagnosis.result import Diagnosis
from modelgen.effects.placement import titled
from modelgen.excitation.writing import set_points, trajectory
from modelgen.report.page import Grid, Part, Run, Text, block
from modelgen.report.words import sentence

NAMES = (f"{STEM}.csv", f"{STEM}_set_points.csv", f"{STEM}.svg")
_PAIRS = (("if this is there", "left"), ("against", "left"), ("expected delta BIC", "right"))
_TESTS = (("on the bench", "left"), ("expected delta BIC", "right"))
_LINES = 7  # looks of lines that are told apart


def followed(e: Experiment) -> str:
    """One line: what to do, and what it promises."""
    first = e.tests[0].evidence if e.tests else None
    by_trajectory = e.proposal is not None and e.best.startswith("run ")
    figure = e.evidence if by_trajectory else first
    if by_trajectory and figure is not None:
        figure *= e.periods / e.run
    said = "" if figure is None else f"; expected delta BIC {figure:z.3g}"
    return f"{e.best}{said}"


def described(d: Diagnosis) -> list[Part]:
    """Parts of the page; none where nothing is to be separated."""
    e = d.next_experiment
    if e is None:
        return []
    separates = " from ".join(titled(d.arm, effect, joint) for effect, joint in e.separates)
    best = _kept(sentence(followed(e)))
    parts: list[Part] = [Text(f"It separates {separates}."), Text([Run(best, "strong")])]
    if e.proposal is not None:
        drawn = charts(d.arm, e)
        parts += [
            Text(_trajectory(e, e.proposal)),
            Grid("Expected evidence", _PAIRS, _pairs(d.arm, e, e.proposal), folds=True),
            block(drawn[:1]),
            block(drawn[1:]),
        ]
    tests = [(_kept(t.text), _evidence(t.evidence)) for t in e.tests]
    return [*parts, Grid("Tests on the bench", _TESTS, tests, folds=True)] if tests else parts


def plans(d: Diagnosis) -> dict[str, str]:
    """Files of the trajectory, by name; none where there is no trajectory."""
    e = d.next_experiment
    if e is None or e.proposal is None:
        return {}
    made = e.proposal.excitation
    return dict(zip(NAMES, (trajectory(made), set_points(made), sheet(charts(d.arm, e), 2)), strict=True))


def charts(arm: Arm, e: Experiment) -> list[Chart]:
    """Positions over a period, and the residual of every wrong cause; none without a trajectory."""
    if e.proposal is None:
        return []
    made, rows = e.proposal.excitation, e.proposal.rows
    names = arm.coordinate_names
    q = made.signals["q"]
    positions = [Curve(made.t, q[:, k], f"s{k % _LINES}", name) for k, name in enumerate(names)]
    units = dict.fromkeys(arm.coordinate_units)
    found = [
        over_time(
            "the trajectory",
            f"position [{', '.join(units)}]",
            positions,
            "Positions of the joints over a period.",
            made.t[0],
        )
    ]
    period = made.problem.settings.period
    t = rows.prepared.t
    shown = (t >= period) & (t < 2 * period) if e.run > 1 else np.ones(len(t), dtype=bool)
    unit = rows.prepared.effort_unit
    for true, wrong, joint, left, noise in differences(e, e.proposal):
        text = f"{titled(arm, *true)}, fitted as {titled(arm, *wrong)}"
        curves = [Curve(t[shown], left[shown], "after", "residual of the wrong cause")]
        y_label = f"residual at {names[joint]} [{unit[joint] if joint < len(unit) else 'A'}]"
        bands = [Band(-noise, noise, "noise")]
        begin = t[shown][0]
        found.append(over_time(text, y_label, curves, f"Residual: {text}.", begin, bands=bands))
    return found


def _trajectory(e: Experiment, p: Proposal) -> str:
    s = p.excitation.problem.settings
    used = max(p.excitation.usage.values(), default=0.0)
    text = (
        f"{STEM}.csv holds a period of {s.period:z.4g} s, {STEM}_set_points.csv the same for a position "
        f"controller in motor coordinates; {100 * used:z.0f} % of the tightest limit is used. The evidence "
        f"is that of {e.run} periods with the noise of the training records"
    )
    text += "." if e.periods == e.run else f"; {e.periods} separate the causes."
    if e.assumed:
        text += f" Not in the description, from the training records: {', '.join(e.assumed)}."
    return text


def _pairs(arm: Arm, e: Experiment, p: Proposal) -> list[tuple[str, str, str]]:
    names = [titled(arm, *h.candidate.place) for h in e.members]
    count = range(len(names))
    return [
        (names[i], names[j], _evidence(float(p.evidence[i, j])))
        for i in count
        for j in count
        if np.isfinite(p.evidence[i, j])
    ]


def _evidence(value: float | None) -> str:
    """A delta BIC, of which less than a tenth says nothing."""
    return "" if value is None else f"{value:z.1f}"


def _kept(text: str) -> str:
    """A text whose numbers keep their units on one line."""
    return re.sub(r"(\d) (s|deg|mm|g|mrad)\b", "\\1\N{NO-BREAK SPACE}\\2", text)
