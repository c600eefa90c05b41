"""How far the value of an elastic joint may be off for the inertia of its drive.

What a joint lags by follows from the inertia of its links: what the records show, less that of the drive. The
description has this from a data sheet, or it was split from nominal links; the records tell it as far as the
joint fits better with another one.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from modelgen.diagnosis.candidates import FittedCandidate, beside, system_of
from modelgen.diagnosis.equations import Equations, described_by
from modelgen.diagnosis.extended.findings import Estimate
from modelgen.diagnosis.selection import Selection, Spread, best_beside, smooth
from modelgen.effects.placement import extended_arm
from modelgen.evaluation import Evaluator
from modelgen.functions.nominal import factor_value

STEP = 0.1  # of an inertia, over which slopes are taken


def with_drive_inertia(
    spread: Spread, selection: Selection, equations: Equations, split: Mapping[int, Estimate]
) -> Spread:
    """The deviations of the causes, those of elastic joints at measured motors with what the inertia of their
    drives may be off by.

    split: inertia of the drives, by the number of the joint, that was split from the links'.
    """
    causes = list(spread.causes)
    for k, cause in enumerate(selection.causes):
        trial, joint = cause.trial, cause.trial.candidate.joint
        if joint is None or not smooth(trial, equations):
            continue
        known = _known(joint, selection, equations, split.get(joint))
        if known is not None:
            moved = _moved(trial, joint, *known, selection, equations)
            causes[k] = {name: math.hypot(std, moved.get(name, 0.0)) for name, std in causes[k].items()}
    return replace(spread, causes=causes)


def _known(
    joint: int, selection: Selection, equations: Equations, split: Estimate | None
) -> tuple[float, float] | None:
    """Inertia at the motor of the drive at a joint (from 1), and its deviation; None where the records show
    it, or nothing says how large it is.
    """
    model, scatter = equations.model, equations.thresholds.equations.nominal_scatter
    for drive in model.grouping.drives:
        if model.arm.coordinates.index(drive.joint) + 1 != joint:
            continue
        if split is not None:
            base, said = selection.system.base, equations.rows[0].baseline.said
            factor = abs(factor_value(drive.factor, model.arm.symbols))
            links = max(0.0, abs(float(base[drive.base])) / factor - split.value)
            return None if said is None else (split.value, scatter * said.scatter(base) * links)
        if drive.nominal is not None:
            return float(drive.nominal), scatter * abs(float(drive.nominal))
    return None


def _moved(
    trial: FittedCandidate, joint: int, inertia: float, std: float, selection: Selection, equations: Equations
) -> dict[str, float]:
    """By how much the values of an elastic joint may be off, for an inertia of its drive that is known so.

    From its description and the records, as two measurements of it (weights by their variances); a value that
    stays where the description has it is off by what the two differ in too.
    """
    others = [c.trial for c in selection.causes if c.trial is not trial]
    step, ends = STEP * inertia, []
    for side in (-1.0, 1.0):
        arm = extended_arm(equations.arm, described_by({joint: inertia + side * step}))
        there = equations.with_evaluator(Evaluator(arm))
        found = best_beside(trial, [trial.values], others, there)
        gain = None if found is None else beside(found, system_of(there, others, selection.system))
        if found is None or gain is None:
            return {}
        ends.append((found.parameters, gain.delta_bic))
    (low, below), (high, above) = ends
    rest = beside(trial, system_of(equations, others, selection.system))
    here = (below + above) / 2.0 if rest is None else rest.delta_bic
    lost = max(0.0, 2.0 * here - below - above)  # twice the evidence lost by a step, as delta BIC
    variance = 1.0 / (1.0 / std**2 + lost / (2.0 * step**2)) if std > 0.0 else 0.0
    shift = variance * (above - below) / (4.0 * step)
    off = math.sqrt(variance + shift**2) / (2.0 * step)
    return {name: off * abs(high[name] - low[name]) for name in low.keys() & high.keys()}
