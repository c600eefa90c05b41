"""From the stages to what is reported: named causes, errors on the test record, settings."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from modelgen.dataset import Settings, choose
from modelgen.dataset.inspection import inspect_records
from modelgen.dataset.processing.splitting import as_given
from modelgen.description import Arm
from modelgen.diagnosis.adequacy import confirmed, place, possible, significance_of
from modelgen.diagnosis.decision import Decision
from modelgen.diagnosis.equations import Equations, Rows, Study, described_by
from modelgen.diagnosis.extended import (
    Estimate,
    Extension,
    NamedCause,
    Positions,
    base_estimates,
    cause_estimates,
    covariance_of_base,
    errors,
    motion_errors,
    motion_shares,
    on_test,
    replay,
    residuals,
    shares,
    unit_of_efforts,
    with_elastic_doubt,
    without,
)
from modelgen.diagnosis.options import Options
from modelgen.diagnosis.options.thresholds import USUAL, in_band
from modelgen.diagnosis.result.diagnosis import AsIdentified, Diagnosis
from modelgen.diagnosis.result.not_identifiable import not_identifiable
from modelgen.diagnosis.selection import Cause, Selection, Spread, deviations, threshold
from modelgen.diagnosis.validation import Check
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.identification.channels import ABOVE_ALL, effort_questions
from modelgen.identification.doubts import doubts, inertia_below_zero
from modelgen.identification.identify import errors_of, estimates_of
from modelgen.identification.impossible import driven
from modelgen.identification.misread import HARDLY, check_reading
from modelgen.identification.objects import DIAGNOSING, Impossible
from modelgen.numeric import Array


def reported(study: Study, decision: Decision, extension: Extension, options: Options) -> Diagnosis:
    """What was found, with the errors that either model leaves of the test record: its only use."""
    band, selection, arm = decision.band, extension.selection, extension.before.arm
    equations, limits = extension.equations, extension.equations.thresholds.extended
    test = equations.of_record(band.test, extension.before.theta)
    there = on_test(extension, test)
    pair = residuals(test, extension, there)
    described = replay(extension.before, test, limits)
    spread = with_elastic_doubt(deviations(selection, equations), selection, equations, extension.inertias)
    causes = _named(decision, extension, spread)
    played = described, replay(without(extension, there), test, limits) if causes else described
    if causes:
        worth = (
            motion_shares(extension, test, there, played[1], limits)
            if equations.free
            else shares(extension, test, there, pair)
        )
        causes = tuple(replace(cause, share=share) for cause, share in zip(causes, worth, strict=True))
    causes = tuple(
        replace(c, checks=(*c.checks, confirmed(c.share.gain, c.share.low, so)), records=_having(c, so, test))
        for c, so in zip(causes, there, strict=True)
    )
    after, fit = extension.after, decision.remains.fit
    covariance = covariance_of_base(after, equations)
    parameters = base_estimates(extension, spread, [c.parameters for c in causes], covariance)
    values = [(*c.trial.candidate.place, c.trial.parameters) for c in selection.causes]
    split = {number: e.value for number, e in extension.inertias.items()}
    added = *described_by(split), *values
    return Diagnosis(
        arm=arm,
        verdict=decision.verdict,
        reason=decision.reason,
        causes=causes,
        suspects=_suspects(decision, arm),
        not_identifiable=not_identifiable(arm, equations, selection, causes),
        lack_of_fit=fit,
        lack_of_fit_part=None if fit is None else place(fit, equations.rows),
        likeness=decision.remains.likeness,
        errors=motion_errors(study.records[-1], *played, limits)
        if equations.free
        else errors(test, *pair, unit_of_efforts(band.test), limits),
        simulation=played,
        before=extension.before,
        after=after,
        parameters=parameters,
        impossible=_impossible(extension, parameters, covariance),
        next_experiment=None,
        test=test,
        residuals=pair,
        laws=tuple(_law(c, test, extension) for c in selection.causes),
        ranking=selection.turns,
        added=added,
        identified=_identified(study, decision, extension, _answered(extension, test, pair)),
        log=inspect_records(
            [r.prepared for r in equations.rows],
            study.records[-1:],
            band.chosen,
            study.lengths,
            instant=study.instant,
        ),
        settings=_settings(study, decision, selection, options),
        positions=Positions(decision.remains.feigned, decision.correlated),
        inertias=extension.inertias,
    )


def _having(cause: NamedCause, there: bool, test: Rows) -> tuple[str, ...] | None:
    """Names of the records that have a cause, the test record among them where it is there."""
    if cause.records is None or not there:
        return cause.records
    return (*cause.records, test.prepared.record.name)


def _law(cause: Cause, test: Rows, extension: Extension) -> Array:
    """What a cause alone adds to the efforts of the test record (M, n); empty where it cannot stand there."""
    trial, evaluator = cause.trial, extension.equations.evaluator
    try:
        added = evaluator.contribution(*trial.candidate.place, test.motion, trial.parameters, extension.base)
    except InputError:
        return np.zeros((0, 0))
    found = added[test.prepared.rows] * test.gain
    return found if np.isfinite(found).all() else np.zeros((0, 0))


def _identified(
    study: Study, decision: Decision, extension: Extension, answered: Collection[str]
) -> AsIdentified | None:
    """What `modelgen identify` has of the records in this band, None of a free motion or where it refuses.

    answered: joints at which causes answer what is left there.
    """
    equations = extension.equations
    if equations.free:
        return None
    # as identify has them: it has no reason to leave turns out
    *train, test = (p.with_turns() for p in (*(r.prepared for r in equations.rows), decision.band.test))
    try:
        solution, found = errors_of(train, [test], study.model, study.evaluator)
    except InputError:
        return None
    chosen = choose(as_given(study.records[:-1]), Settings(thresholds=study.thresholds.dataset))
    fit = solution.theta, solution.covariance, solution.determined
    asked = check_reading(train, study.model, study.evaluator).questions
    asked += tuple(effort_questions(train, study.model, study.evaluator, zero=ABOVE_ALL, short=False))
    said = {name for doubt in asked for name in doubt.joints}
    asked += tuple(doubt for doubt in decision.remains.drifting if said.isdisjoint(doubt.joints))
    about = doubts(train, study.model, study.evaluator, *fit, whole=decision.verdict != "named")
    left = [doubt for doubt in asked if not set(doubt.joints) <= set(answered)]
    texts = (text.without(DIAGNOSING) for text in (*left, *about))  # this is the diagnosis
    late = study.instant.questions() if study.instant is not None and study.instant.channels else ()
    return AsIdentified(found.rmse, chosen.cutoff, tuple(texts), late)


def _impossible(
    extension: Extension, parameters: Mapping[str, Estimate], covariance: Array
) -> tuple[Impossible, ...]:
    """Questions about values of the extended model that no arm has; none of a free motion, of which links are
    known. parameters, covariance (p, p): of its base parameters.
    """
    after, equations = extension.after, extension.equations
    if equations.free or not extension.selection.causes:
        return ()
    model, names = after.model, after.arm.coordinate_names
    spread = np.array([parameters[b.name].std for b in model.grouping.base])
    found = driven(estimates_of(model, after.parameters, spread), names, signs_tried=True)
    if not any(c.trial.candidate.elastic for c in extension.selection.causes):  # its links lag at any pose
        train = [r.prepared for r in after.rows]
        fit = after.parameters, covariance, np.diag(covariance) > 0.0
        found += inertia_below_zero(train, model, Evaluator(after.arm), *fit)
    return tuple(doubt.without(DIAGNOSING) for doubt in found)


def _answered(extension: Extension, test: Rows, pair: tuple[Array, Array]) -> set[str]:
    """Names of the joints at which what is left is answered: a cause is named there, or one
    elsewhere explains most of it. pair: residuals (M, n) of the test record before and after.
    """
    joints = {cause.trial.candidate.joint for cause in extension.selection.causes}
    names = extension.before.arm.coordinate_names
    if None in joints:
        return set(names)
    before, after = (np.sum(np.where(test.moving, x, 0.0) ** 2, axis=0) for x in pair)
    return {name for j, name in enumerate(names) if j + 1 in joints or after[j] < HARDLY**2 * before[j]}


def _settings(study: Study, decision: Decision, selection: Selection, options: Options) -> dict[str, object]:
    """`settings` of diagnosis.json: what was asked, and how the records were processed."""
    chosen, train = decision.band.chosen, study.records[:-1]
    periods = zip(study.lengths, train, strict=True)
    asked = [effect if joint is None else f"{effect}:{joint}" for effect, joint in options.effects]
    least = in_band(options.thresholds.validation.min_gain_percent, decision.band.equations.narrowed)
    changed = {e.name: e.value for e in options.thresholds.entries()}
    usual = {e.name: e.value for e in USUAL.entries()}
    others = {name: value for name, value in changed.items() if value != usual[name]}
    return {
        "asked": asked or "all",
        "train": [record.name for record in train],
        "test": study.records[-1].name,
        "cutoff_hz": chosen.cutoff,
        "position_cutoff_hz": chosen.position_cutoff,
        "factor": chosen.factor,
        "rest_speeds": [float(f"{gate:.6g}") for gate in chosen.rest_speeds],
        "period_s": [None if p is None else float(f"{p * r.step:.9g}") for p, r in periods],
        "evidence_threshold": threshold(selection.system),
        "simulated_window_s": None
        if decision.band.equations.free
        else options.thresholds.extended.simulated_window,
        "practical_gain_percent": round(least, 3),
        **({"thresholds": others} if others else {}),
    }


def _named(decision: Decision, extension: Extension, spread: Spread) -> tuple[NamedCause, ...]:
    """The causes as they are reported, with aliases and rivals. spread: of the extension's selection."""
    causes, arm = extension.selection.causes, extension.before.arm
    if not causes:
        return ()
    estimates = cause_estimates(extension.selection, extension.equations, spread)
    records = _names(extension.equations)
    result = []
    for cause, same, values, asked in zip(causes, decision.equal, estimates, decision.causes, strict=True):
        aliases = tuple(other.place for other in same)
        rivals = tuple(
            (*t.candidate.place, behind) for t, behind in cause.rivals if t.candidate.place not in aliases
        )
        named = _as_named(arm, cause, values, asked.checks, records)
        checks = _as_reported(named, cause, extension.equations)
        result.append(replace(named, aliases=aliases, ambiguous_with=rivals, checks=checks))
    return tuple(result)


def _as_reported(named: NamedCause, cause: Cause, equations: Equations) -> tuple[Check, ...]:
    """Checks of a cause that say the values and deviations that it is reported with."""
    values = {name: e.value for name, e in named.parameters.items()}
    spread = {name: e.std for name, e in named.parameters.items()}
    anew = {"significant": significance_of(cause.trial, equations, values, spread)}
    said = (anew.get(c.name, c) if c.passed else c for c in named.checks)
    return tuple(
        replace(c, text=possible(cause, equations.arm)) if c.name == "admissible" and c.passed else c
        for c in said
    )


def _suspects(decision: Decision, arm: Arm) -> tuple[NamedCause, ...]:
    """What has evidence and failed a check, with its values as they were found beside the causes."""
    if not decision.suspects:
        return ()
    before, unmeasured = decision.before, confirmed(float("nan"), float("nan"))
    equations = before.system.equations
    values = cause_estimates(before, equations, deviations(before, equations))
    estimates = {id(cause): own for cause, own in zip(before.causes, values, strict=True)}
    records, found = _names(equations), []
    for e in decision.suspects:
        named = _as_named(arm, e.cause, estimates[id(e.cause)], e.checks, records)
        checks = _as_reported(named, e.cause, equations)
        found.append(replace(named, checks=(*checks, unmeasured)))
    return tuple(found)


def _names(equations: Equations) -> list[str]:
    return [r.prepared.record.name for r in equations.rows]


def _as_named(
    arm: Arm,
    cause: Cause,
    values: Mapping[str, Estimate],
    checks: tuple[Check, ...],
    records: Sequence[str],
) -> NamedCause:
    """A cause with its values and checks, without what only the test record or its rivals say.

    Deviations hold what the records differ by (Birge 1932).
    """
    c = cause.trial.candidate
    times = float(np.prod([check.widened for check in checks]))
    having = [name for k, name in enumerate(records) if k not in c.absent]
    return NamedCause(
        effect=c.effect,
        joint=c.joint,
        parameters={name: replace(e, std=times * e.std) for name, e in values.items()},
        delta_bic=cause.delta_bic,
        cross_gain=cause.cross_gain,
        expected_gain=cause.expected_gain,
        joint_name=None if c.joint is None else arm.joints[arm.coordinates[c.joint - 1]].name,
        checks=checks,
        records=tuple(having) if c.absent else None,
    )
