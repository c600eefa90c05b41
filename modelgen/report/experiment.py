"""The next experiment in the report, and its files: the trajectory, its set-points, a picture."""

from __future__ import annotations

from typing import Any

import numpy as np

from modelgen.diagnosis.experiment import STEM, Experiment, differences
from modelgen.diagnosis.result import Diagnosis
from modelgen.excitation.writing import set_points, trajectory
from modelgen.figures import COLOURS
from modelgen.report.diagnosis_figures import inline
from modelgen.report.figures import Sketch

NAMES = (f"{STEM}.csv", f"{STEM}_set_points.csv", f"{STEM}.svg")


def followed(e: Experiment) -> str:
    """One line: what to do, and what it promises."""
    first = e.tests[0].evidence if e.tests else None
    by_trajectory = e.proposal is not None and e.best.startswith("run ")
    figure = e.evidence if by_trajectory else first
    if by_trajectory and figure is not None:
        figure *= e.periods / e.run
    said = "" if figure is None else f"; expected delta BIC {figure:.3g}"
    return f"{e.best}{said}"


def described(e: Experiment | None, drawn: str) -> dict[str, Any] | None:
    """For the page. drawn: its picture."""
    if e is None:
        return None
    return {
        "separates": " from ".join(_place(effect, joint) for effect, joint in e.separates),
        "best": followed(e)[0].upper() + followed(e)[1:] + ".",
        "trajectory": _trajectory(e),
        "pairs": _pairs(e),
        "picture": "" if e.proposal is None else inline(drawn),
        "tests": [(t.text, "" if t.evidence is None else f"{t.evidence:.3g}") for t in e.tests],
    }


def plans(d: Diagnosis, drawn: str) -> dict[str, str]:
    """Files of the trajectory, by name; none where there is no trajectory. drawn: its picture."""
    e = d.next_experiment
    if e is None or e.proposal is None:
        return {}
    made = e.proposal.excitation
    return dict(zip(NAMES, (trajectory(made), set_points(made), drawn), strict=True))


def picture(e: Experiment) -> Sketch:
    """The joints' positions over a period, and what a wrong cause would leave over."""
    assert e.proposal is not None
    made, rows = e.proposal.excitation, e.proposal.rows
    pairs = differences(e, e.proposal)
    sketch = Sketch(1 + len(pairs), 1, (9.0, 2.0 * (1 + len(pairs))))
    axes = sketch.axes()
    q = made.signals["q"]
    for k in range(q.shape[1]):
        axes[0, 0].plot(made.t, q[:, k], color=COLOURS[k % len(COLOURS)], label=f"joint {k + 1}")
    axes[0, 0].set_ylabel("position [rad, m]")
    axes[0, 0].legend(loc="upper right", fontsize=7)
    period = made.problem.settings.period
    t = rows.prepared.t
    shown = (t >= period) & (t < 2 * period) if e.run > 1 else np.ones(len(t), dtype=bool)
    for axis, (text, joint, left, noise) in zip(axes[1:, 0], pairs, strict=True):
        axis.axhspan(-noise, noise, color="#dddddd", label="noise")
        axis.plot(t[shown] - t[shown][0], left[shown], color=COLOURS[1])
        axis.set_title(f"{text}: left over at joint {joint + 1}", fontsize=8)
        axis.set_ylabel("input")
        axis.legend(loc="upper right", fontsize=7)
    axes[-1, 0].set_xlabel("time [s]")
    return sketch


def _trajectory(e: Experiment) -> str:
    if e.proposal is None:
        return ""
    s = e.proposal.excitation.problem.settings
    used = max(e.proposal.excitation.usage.values(), default=0.0)
    text = (
        f"{STEM}.csv holds a period of {s.period:.4g} s, {STEM}_set_points.csv the same for a position "
        f"controller in motor coordinates; {100 * used:.0f} % of the tightest limit is used. The evidence is "
        f"that of {e.run} periods with the noise of the training records"
    )
    text += "." if e.periods == e.run else f"; {e.periods} tell the causes apart."
    if e.assumed:
        text += f" Not in the description, taken from the training records: {', '.join(e.assumed)}."
    return text


def _pairs(e: Experiment) -> list[tuple[str, str, str]]:
    if e.proposal is None:
        return []
    names = [_place(*h.candidate.place) for h in e.members]
    count = range(len(names))
    return [
        (names[i], names[j], f"{e.proposal.evidence[i, j]:.3g}")
        for i in count
        for j in count
        if np.isfinite(e.proposal.evidence[i, j])
    ]


def _place(effect: str, joint: int | None) -> str:
    return effect if joint is None else f"{effect} at joint {joint}"
