"""Inertia of the drives before elastic joints and play, where the arm's parameters hold it with the links'.

The links' share decides what a spring of some stiffness does, and no rigid model's parameter tells it. Where
the description gives the drive none, the drive's is what was identified of both beyond the links' nominal
inertials.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

from modelgen.base_parameters.drives import INERTIA
from modelgen.description import Arm, EffectUse
from modelgen.diagnosis.candidates import COMPLIANT
from modelgen.diagnosis.causes import Cause
from modelgen.diagnosis.compliance import best_beside
from modelgen.diagnosis.objects import Estimate
from modelgen.diagnosis.rows import Array, Rows
from modelgen.diagnosis.selection import Selection
from modelgen.diagnosis.stiffness import with_trials
from modelgen.errors import InputError
from modelgen.functions import Model
from modelgen.functions.nominal import factor_value, nominal_links
from modelgen.probing import Prober

SOFTER = (0.5, 0.2, 0.08)  # times the stiffness that was found with the inertia of drive and links together
LEAST = 0.05  # of the inertia of links and drive together, that is either's


def inertias(model: Model, base: Array, causes: Sequence[Cause]) -> dict[int, Estimate]:
    """Inertia by coordinate (from 1) of drives before the compliant joints among the causes, at the motor.

    base: parameters (p,). Of those alone that base parameters of links contain, and that the description
    leaves without a value; none where links have no nominal inertials, or these leave next to nothing to the
    drive, or to the link.
    """
    try:
        known = nominal_links(model)
    except InputError:
        return {}
    compliant = {c.trial.candidate.joint for c in causes if c.trial.candidate.effect in COMPLIANT}
    places = {index: number for number, index in enumerate(model.arm.coordinates, 1)}
    found = {}
    for drive in model.grouping.drives:
        number = places[drive.joint]
        if number not in compliant or drive.nominal is not None:
            continue
        of = next(k for k, b in enumerate(model.grouping.base) if b.representative == drive.representative)
        terms = [(k, f) for k, f in model.grouping.base[of].terms if k != drive.standard]
        names = [model.standard[k].name for k, _ in terms]
        if not all(name in known for name in names):
            continue
        factors = [factor_value(f, model.arm.symbols) for _, f in terms]
        links = sum(known[name] * f for name, f in zip(names, factors, strict=True))
        whole = float(base[of])
        if LEAST * whole < links < (1.0 - LEAST) * whole:
            factor = factor_value(drive.factor, model.arm.symbols)
            value = float(f"{(whole - links) / factor:.9g}")
            found[number] = Estimate(value, math.nan, model.standard[drive.standard].unit)
    return found


def with_inertias(arm: Arm, values: Mapping[int, Estimate]) -> Arm:
    """The arm with nominal inertia of its drives by coordinate (from 1)."""
    joints = list(arm.joints)
    for number, value in values.items():
        index = arm.coordinates[number - 1]
        uses = tuple(
            EffectUse(INERTIA, {"inertia": value.value}, u.where) if u.name == INERTIA else u
            for u in joints[index].effects
        )
        joints[index] = replace(joints[index], effects=uses)
    return replace(arm, joints=tuple(joints))


def refound(
    selection: Selection, numbers: Collection[int], rows: Sequence[Rows], prober: Prober
) -> Selection | None:
    """The selection with the values of the compliant joints `numbers` that are best on the arm of `prober`;
    None where rigid ones are better there.

    The search begins at what was found, and at softer ones: slowly, a joint does the same with half the
    links' inertia and a quarter of its stiffness.
    """
    trials = [c.trial for c in selection.causes]
    for k, trial in enumerate(trials):
        if trial.candidate.effect in COMPLIANT and trial.candidate.joint in numbers:
            others = [t for t in trials if t is not trial]
            softer = [{**trial.values, "stiffness": f * trial.values["stiffness"]} for f in SOFTER]
            starts = [trial.values, *softer] if "stiffness" in trial.values else [trial.values]
            found = best_beside(trial, starts, others, rows, prober)
            if found is None:
                return None
            trials[k] = found
    return with_trials(selection, trials, rows)
