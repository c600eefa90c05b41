"""How far the values of an elastic joint may be off, beside what noise of the efforts makes of them.

What a joint lags by follows from the inertia of its links: what the records show, less that of the drive. The
description has this from a data sheet, or it was split from nominal links; the records tell it as far as the
joint fits better with another one. It is simulated along measured positions: what their rounding makes it
ring is nothing that the efforts have, and more damping leaves less of it. And efforts that were read half a
sample later look like damping.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

from modelgen.dataset.processing.rounding import position_steps
from modelgen.diagnosis.candidates import FittedCandidate, beside, system_of
from modelgen.diagnosis.equations import Equations, described_by
from modelgen.diagnosis.evidence import System
from modelgen.diagnosis.extended.findings import Estimate
from modelgen.diagnosis.selection import Selection, Spread, best_beside, effort_rates, refit_elastic, smooth
from modelgen.effects.placement import extended_arm
from modelgen.evaluation import Evaluator
from modelgen.functions.nominal import factor_value
from modelgen.identification.rounded_positions import prepared_anew
from modelgen.numeric import Array

STEP = 0.1  # of an inertia, over which slopes are taken


def with_elastic_doubt(
    spread: Spread, selection: Selection, equations: Equations, split: Mapping[int, Estimate]
) -> Spread:
    """The deviations of the causes, those of elastic joints at measured motors with what the inertia of their
    drives may be off by, the efforts' instant, and what the rounding of positions does.

    split: inertia of the drives, by the number of the joint, that was split from the links'.
    """
    trials, causes = [c.trial for c in selection.causes], list(spread.causes)
    elastic = [k for k, trial in enumerate(trials) if smooth(trial, equations)]
    late = _by_instant(selection, equations) if elastic else []
    theta = selection.system.theta[: equations.unknowns]
    for k in elastic:
        trial, joint = trials[k], trials[k].candidate.joint
        assert joint is not None
        others = [t for t in trials if t is not trial]
        doubts = [late[k], _by_rounding(trial, others, equations, theta)]
        known = _known(joint, selection, equations, split.get(joint))
        if known is not None:
            doubts.append(_by_inertia(trial, joint, *known, others, equations, selection.system))
        causes[k] = {
            name: math.hypot(std, *(doubt.get(name, 0.0) for doubt in doubts))
            for name, std in causes[k].items()
        }
    return replace(spread, causes=causes)


def _by_rounding(
    trial: FittedCandidate, others: Sequence[FittedCandidate], equations: Equations, theta: Array
) -> dict[str, float]:
    """By how much the values of an elastic joint move where positions are rounded once more: about as far as
    their rounding has moved them (Cook and Stefanski 1994). theta: (k,), the arm's unknowns.
    """
    if not any(position_steps(r.prepared.record).any() for r in equations.rows):
        return {}
    rows = [
        replace(equations.of_record(prepared_anew(r.prepared, 0), theta), moving=r.moving)
        for r in equations.rows
    ]
    found = best_beside(trial, [trial.values], others, equations.with_rows(rows))
    return {} if found is None else _apart(trial, found)


def _by_instant(selection: Selection, equations: Equations) -> list[dict[str, float]]:
    """By how much the values of the causes move where the efforts were read later by as much as nobody knows
    (`Record.hold_std`): half a sample does much what damping does.
    """
    if not any(r.prepared.record.hold_std for r in equations.rows):
        return [{} for _ in selection.causes]
    rows = [
        replace(r, effort=r.effort + r.prepared.record.hold_std * rate)
        for r, rate in zip(equations.rows, effort_rates(selection, equations), strict=True)
    ]
    later = refit_elastic(selection, equations.with_rows(rows)).causes
    return [_apart(c.trial, other.trial) for c, other in zip(selection.causes, later, strict=True)]


def _apart(one: FittedCandidate, other: FittedCandidate) -> dict[str, float]:
    both = one.parameters.keys() & other.parameters.keys()
    return {name: abs(one.parameters[name] - other.parameters[name]) for name in both}


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


def _by_inertia(
    trial: FittedCandidate,
    joint: int,
    inertia: float,
    std: float,
    others: Sequence[FittedCandidate],
    equations: Equations,
    system: System,
) -> dict[str, float]:
    """By how much the values of an elastic joint may be off, for an inertia of its drive that is known so.

    From its description and the records, as two measurements of it (weights by their variances); a value that
    stays where the description has it is off by what the two differ in too.
    """
    step, ends = STEP * inertia, []
    for side in (-1.0, 1.0):
        arm = extended_arm(equations.arm, described_by({joint: inertia + side * step}))
        there = equations.with_evaluator(Evaluator(arm))
        found = best_beside(trial, [trial.values], others, there)
        gain = None if found is None else beside(found, system_of(there, others, system))
        if found is None or gain is None:
            return {}
        ends.append((found.parameters, gain.delta_bic))
    (low, below), (high, above) = ends
    rest = beside(trial, system_of(equations, others, system))
    here = (below + above) / 2.0 if rest is None else rest.delta_bic
    lost = max(0.0, 2.0 * here - below - above)  # twice the evidence lost by a step, as delta BIC
    variance = 1.0 / (1.0 / std**2 + lost / (2.0 * step**2)) if std > 0.0 else 0.0
    # A slope says where to, not how far: what is known so is hardly off by more than twice its deviation.
    shift = min(abs(variance * (above - below) / (4.0 * step)), 2.0 * std)
    off = math.sqrt(variance + shift**2) / (2.0 * step)
    return {name: off * abs(high[name] - low[name]) for name in low.keys() & high.keys()}
