"""Inertia of drives before elastic joints and play, where the arm's parameters hold it with the links'."""

from __future__ import annotations

import math
from collections.abc import Collection

from modelgen.diagnosis.equations import Equations, described_by, hidden_inertias
from modelgen.diagnosis.extended.findings import Estimate
from modelgen.diagnosis.selection import Selection, best_beside, with_trials
from modelgen.effects.placement import extended_arm
from modelgen.evaluation import Evaluator

SOFTER = (0.5, 0.2, 0.08)  # times the stiffness that was found with the inertia of drive and links together


def inertias(selection: Selection, equations: Equations) -> dict[int, Estimate]:
    """Inertia by coordinate (from 1) of drives before the compliant joints among the causes, at the motor."""
    model, least = equations.model, equations.thresholds.extended.min_inertia_share
    compliant = {c.trial.candidate.joint for c in selection.causes if c.trial.candidate.elastic}
    joints = [number for number in compliant if number is not None]
    units = {model.arm.coordinates.index(d.joint) + 1: d.name for d in model.grouping.drives}
    named = {p.name: p.unit for p in model.standard}
    found = hidden_inertias(model, selection.system.base, joints, least)
    return {number: Estimate(value, math.nan, named[units[number]]) for number, value in found.items()}


def split_drive_inertia(
    selection: Selection, equations: Equations
) -> tuple[dict[int, Estimate], Selection, Equations]:
    """`inertias`, and with them the selection and the equations of the arm that has them; all as they were,
    and none, where compliant joints do no better with them than rigid ones.
    """
    values = inertias(selection, equations)
    if values:
        added = described_by({number: e.value for number, e in values.items()})
        split = equations.with_evaluator(Evaluator(extended_arm(equations.arm, added)))
        found = refound(selection, values, split)
        if found is not None:
            return values, found, split
    return {}, selection, equations


def refound(selection: Selection, numbers: Collection[int], equations: Equations) -> Selection | None:
    """The selection with the values of the compliant joints `numbers` that are best on the equations' arm;
    None where rigid ones are better there.

    The search begins at what was found, and at softer ones: slowly, a joint does the same with half the
    links' inertia and a quarter of its stiffness.
    """
    trials = [c.trial for c in selection.causes]
    for k, trial in enumerate(trials):
        if trial.candidate.elastic and trial.candidate.joint in numbers:
            others = [t for t in trials if t is not trial]
            starts = [trial.values]
            if "stiffness" in trial.values:  # which a gap behind a link's own position has not
                starts += [{**trial.values, "stiffness": f * trial.values["stiffness"]} for f in SOFTER]
            found = best_beside(trial, starts, others, equations)
            if found is None:
                return None
            trials[k] = found
    return with_trials(selection, trials, equations)
