"""Inertia of the drives before elastic joints and play, where the arm's parameters hold it with the links'.

The links' share decides what a spring of some stiffness does, and no rigid model's parameter tells it. Where
the description gives the drive none, the drive's is what was identified of both beyond the links' nominal
inertials.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence

from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.extended.findings import Estimate
from modelgen.diagnosis.selection import Cause, Selection, best_beside, with_trials
from modelgen.effects import CATALOGUE
from modelgen.effects.placement import Found, extended_arm
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.functions.nominal import factor_value, nominal_links
from modelgen.numeric import Array

SOFTER = (0.5, 0.2, 0.08)  # times the stiffness that was found with the inertia of drive and links together


def inertias(model: Model, base: Array, causes: Sequence[Cause], least: float) -> dict[int, Estimate]:
    """Inertia by coordinate (from 1) of drives before the compliant joints among the causes, at the motor.

    base: parameters (p,). Of those alone that base parameters of links contain, and that the description
    leaves without a value; none where links have no nominal inertials, or these leave to the drive, or to the
    link, less than the share `least`.
    """
    try:
        known = nominal_links(model.arm)
    except InputError:
        return {}
    compliant = {c.trial.candidate.joint for c in causes if c.trial.candidate.elastic}
    symbols, units = model.arm.symbols, {p.name: p.unit for p in model.standard}
    found = {}
    for drive in model.grouping.drives:
        number = model.arm.coordinates.index(drive.joint) + 1
        if number not in compliant or drive.nominal is not None:
            continue
        terms = {model.standard[k].name: factor for k, factor in model.grouping.base[drive.base].terms}
        factor = factor_value(terms.pop(drive.name), symbols)
        if not terms.keys() <= known.keys():
            continue
        links = sum(known[name] * factor_value(f, symbols) for name, f in terms.items())
        whole = float(base[drive.base])
        if least * whole < links < (1.0 - least) * whole:
            value = float(f"{(whole - links) / factor:.9g}")
            found[number] = Estimate(value, math.nan, units[drive.name])
    return found


def described_by(values: Mapping[int, Estimate]) -> list[Found]:
    """Inertia of drives by coordinate (from 1) as what a description is extended by."""
    rotor = next(effect for effect in CATALOGUE.values() if effect.of_rotor)
    (inertia,) = rotor.linear
    return [(rotor.name, number, {inertia.name: e.value}) for number, e in values.items()]


def split_drive_inertia(
    selection: Selection, equations: Equations
) -> tuple[dict[int, Estimate], Selection, Equations]:
    """`inertias`, and with them the selection and the equations of the arm that has them; all as they were,
    and none, where compliant joints do no better with them than rigid ones.
    """
    least = equations.thresholds.extended.min_inertia_share
    values = inertias(equations.model, selection.system.base, selection.causes, least)
    if values:
        split = equations.with_evaluator(Evaluator(extended_arm(equations.arm, described_by(values))))
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
