"""Thresholds that are read in the middle of a search, a selection or a plan, each with another value and a
decision of that stage, called by itself. What a decision weighs stands in for equations where these would
take long to have it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any
from unittest.mock import patch

import numpy as np
from diagnosis_support import ARM, made
from threshold_support import Seen, known, law, real, valued

from modelgen.description import Inertial
from modelgen.diagnosis.adequacy.checks import _stable, significant
from modelgen.diagnosis.adequacy.distinguishable import aliases
from modelgen.diagnosis.adequacy.dominance import dominance
from modelgen.diagnosis.adequacy.explained import left_smoothly
from modelgen.diagnosis.adequacy.free_form import FreeForm, free_forms, further_form
from modelgen.diagnosis.candidates import FittedCandidate, candidates
from modelgen.diagnosis.candidates.candidate import Candidate
from modelgen.diagnosis.candidates.search import Search
from modelgen.diagnosis.equations import Equations, Unknowns
from modelgen.diagnosis.evidence import System
from modelgen.diagnosis.experiment import experiment, next_experiment, setup
from modelgen.diagnosis.experiment.discrimination import Discriminator, hypothesis
from modelgen.diagnosis.experiment.trajectory import as_run
from modelgen.diagnosis.extended import drive_inertia, extended_model
from modelgen.diagnosis.extended.uncertainty import cause_estimates
from modelgen.diagnosis.options import Thresholds
from modelgen.diagnosis.selection import deviations, stepwise
from modelgen.diagnosis.selection.backward import backward_elimination
from modelgen.diagnosis.selection.cause import Cause, Selection
from modelgen.diagnosis.selection.history import Ranked
from modelgen.diagnosis.selection.refit import refit
from modelgen.diagnosis.validation.conditions import Conditions, Judgement, instrumented
from modelgen.excitation.problem import problem
from modelgen.functions import build_model
from modelgen.jobs import HERE
from modelgen.numeric import Array
from modelgen.thresholds import Value


def constant(x: Array) -> Array:
    """A law that does not depend on the position."""
    return np.ones(len(x))


def selected(equations: Equations, *trials: FittedCandidate, delta_bic: float = 90.0) -> Selection:
    """The causes, and the system with them."""
    system = equations
    tables = [
        np.concatenate([r.columns, *(t.columns[k] for t in trials)], axis=2)
        for k, r in enumerate(system.rows)
    ]
    causes = [Cause(t, delta_bic, 5.0, 5.0) for t in trials]
    return Selection(causes, System(equations, tables), [])


# Candidates


def searched(limits: Thresholds, effect: str) -> Any:
    """Evidence of the best that the effect can do at the first joint, and the values searched for."""
    equations = real(limits)
    candidate = next(c for c in candidates(equations) if c.place == (effect, 1))
    found = Search(System(equations)).trial(candidate)
    return found and (found.gain.delta_bic, found.values)


# Validation


def gates(limits: Thresholds, count: int = 2, *, repeat: bool = True, blur: float = 0.0) -> Any:
    """Judgement of a constant where there is one, by so many records."""
    equations = known(limits, lambda x: 0.4 * constant(x), repeat=repeat)
    rows, periods = list(equations.rows), list(equations.periods)
    for seed in range(1, count // 2):
        rows += made(lambda x: 0.4 * constant(x), seed)[0]
        periods += periods[:2]
    equations = replace(equations, rows=rows, periods=periods, blur=np.array([blur]))
    return Conditions(System(equations), []).judged(law(equations, constant))


def faint_in_one(limits: Thresholds) -> bool:
    """Whether impacts that are four times weaker in one record are said to be in the other alone."""
    equations = known(limits)
    trial = law(equations, np.sign, "backlash")
    first, second = trial.columns
    return Conditions(System(equations), [])._somewhere(replace(trial, columns=[0.25 * first, second]))


def at_first_joint(equations: Equations, columns: Sequence[Array]) -> FittedCandidate:
    """An offset of the first joint's friction with columns (M,) of the records of two joints."""
    tables = [column[:, None, None] * [[1.0], [0.0]] for column in columns]
    gain = System(equations).gain(tables)
    assert gain is not None
    return FittedCandidate(Candidate("friction_offset", 1), {}, tables, gain)


def by_instruments(limits: Thresholds) -> bool:
    """Whether an offset that is there is seen where the positions have no errors."""
    equations = real(limits)
    given = [replace(r, effort=r.effort + np.array([0.6, 0.0])) for r in equations.rows]
    equations = equations.with_rows(given)
    return instrumented(at_first_joint(equations, [np.ones(len(r.effort)) for r in given]), System(equations))


# Selection


def of_all_joints(limits: Thresholds) -> Any:
    """Why what promises for all joints half of what it does at one is not taken."""
    pairs = {None: Judgement(5.0, 5.0, ""), 1: Judgement(10.0, 10.0, "")}
    trials = [valued(90.0, joint=joint) for joint in pairs]
    equations = real(limits)
    steps = stepwise._Steps(equations, [], None, HERE, None)
    asked = SimpleNamespace(judged=lambda t: pairs[t.candidate.joint])
    with patch.object(stepwise, "harmless", return_value=True):
        return [by.refused for _, by in steps._judged(trials, asked)]  # type: ignore[arg-type]


def impossible(limits: Thresholds) -> Any:
    """Effects that stay of two, of which one would have to brake backwards."""
    equations = known(limits)
    backwards = law(equations, lambda x: -constant(x), "coulomb_friction")
    other = law(equations, np.sin, "friction_offset")
    found = selected(equations, backwards, other)
    stayed, _ = backward_elimination(found.causes, found.system, -1e9)
    return [c.trial.candidate.effect for c in stayed]


def anew(limits: Thresholds) -> Any:
    """Columns of an effect that depend on the arm's parameters, once these were found beside it."""
    equations = real(limits)
    candidate = next(c for c in candidates(equations) if c.place == ("time_delay", 1))
    trial = Search(System(equations)).trial(candidate)
    assert trial is not None
    cause = Cause(trial, 90.0, 5.0, 5.0)
    refit([cause], equations)
    return [float(np.abs(c).sum()) for c in cause.trial.columns]


def turns(limits: Thresholds) -> int:
    """How many causes are looked for where there is always one more."""
    with patch.object(stepwise._Steps, "take", return_value=True) as taken:
        stepwise.forward_selection(real(limits), [])
    return taken.call_count


# Adequacy


def equal(limits: Thresholds) -> Any:
    """Effects that span what one of two others does."""
    equations = real(limits)
    places = [("friction_offset", 1), ("asymmetric_viscous_friction", 1), ("viscous_friction", 1)]
    offset, *pool = [Candidate(*place) for place in places]
    base = System(equations).base
    return [[c.effect for c in found] for found in aliases([offset], pool, equations, base)]


def absorbed(limits: Thresholds) -> Any:
    """Whether a tilt of the base is still an error of the first encoder, and not absorbed by the arm."""
    equations = real(limits)
    pool = candidates(equations)
    tilt, error = (
        next(c for c in pool if c.place == place) for place in (("base_tilt", None), ("encoder_offset", 1))
    )
    return aliases([tilt], [error], equations, System(equations).base) == [[error]]


def dominated(limits: Thresholds) -> bool:
    equations = real(limits)
    cause = Cause(valued(50.0), 50.0, 5.0, 5.0)
    refused = Ranked("spring", 1, 70.0, 1.0, 1.0, "gain")
    taken = Ranked(*cause.trial.candidate.place, 50.0, 5.0, 5.0, "", chosen=True)
    found = dominance(cause, Selection([cause], System(equations), [[refused, taken]]))
    return found.ahead > found.most


def waving(limits: Thresholds) -> tuple[Equations, list[Array]]:
    """Equations with half of a wave over the first joint's position in its effort, where nothing repeats; and
    the wave in every record.
    """
    equations = replace(real(limits), periods=[None] * len(real(limits).rows))
    hidden = [np.sin(3.0 * r.prepared.picked(r.prepared.q)[:, 0]) for r in equations.rows]
    given = [
        replace(r, effort=r.effort + 0.5 * x[:, None] * [1.0, 0.0])
        for r, x in zip(equations.rows, hidden, strict=True)
    ]
    return equations.with_rows(given), hidden


def elastic_while(limits: Thresholds, slow: bool) -> FreeForm:
    """The form of an elastic joint that explains what is there only while its joint is slow, or always."""
    bare, rows, columns = real(limits), [], []
    speeds = [np.abs(r.prepared.picked(r.prepared.dq)[:, 0]) for r in bare.rows]
    moving = np.concatenate([x[r.moving[:, 0]] for x, r in zip(speeds, bare.rows, strict=True)])
    for r, speed in zip(bare.rows, speeds, strict=True):
        where = speed < np.quantile(moving, 0.05) if slow else speed >= 0.0
        column = np.zeros((*r.effort.shape, 1))
        column[:, 0, 0] = where * np.sin(np.arange(len(where)))
        columns.append(column)
        rows.append(replace(r, effort=r.effort + 10.0 * r.effort[:, 0].std() * column[:, :, 0]))
    equations = bare.with_rows(rows)
    gain = System(equations).gain(columns)
    assert gain is not None
    trial = FittedCandidate(Candidate("joint_flexibility", 1), {}, columns, gain)
    return free_forms(selected(equations, trial), equations, {})[1]


def freely(limits: Thresholds, column: Any) -> bool:
    """Whether a free function of a joint's position outdoes a cause with this law of the right one, where
    nothing repeats.
    """
    equations, hidden = waving(limits)
    trial = at_first_joint(equations, [column(x) for x in hidden])
    return free_forms(selected(equations, trial), equations, {})[1].as_good


def left_beside(limits: Thresholds) -> bool:
    """Whether functions of no law explain something beside a cause of a part of a wave, where nothing
    repeats.
    """
    equations, hidden = waving(limits)
    trial = at_first_joint(equations, [np.ones(len(x)) for x in hidden])
    return bool(left_smoothly(selected(equations, trial).system, [0])[0] > 0.0)


def at_both_joints(limits: Thresholds) -> bool:
    """Whether a law of two joints, of which one has it, is outdone by itself with a size at each."""
    equations, hidden = waving(limits)
    tables = [x[:, None, None] * np.ones((2, 1)) for x in hidden]
    gain = System(equations).gain(tables)
    assert gain is not None
    trial = FittedCandidate(Candidate("friction_offset", 1), {}, tables, gain)
    form = free_forms(selected(equations, trial), equations, {})[1]
    return form.apart and form.as_good


def at_any_pace(limits: Thresholds) -> bool:
    """Whether a delay of which slow motion has all, and fast motion nothing, is outdone by itself with a size
    for each.
    """
    equations, hidden = waving(limits)
    tables = [np.zeros((len(x), 2, 1)) for x in hidden]
    for table, x in zip(tables, hidden, strict=True):
        table[:, 0, 0] = x + 0.5 * np.std(x) * np.cos(np.pi * np.arange(len(x)))
    gain = System(equations).gain(tables)
    assert gain is not None
    trial = FittedCandidate(Candidate("time_delay", None), {}, tables, gain)
    form = further_form([trial], System(equations))
    return form.pace and form.as_good


def claimed(limits: Thresholds) -> Any:
    equations = known(limits)
    trial = law(equations, constant, "payload_change")
    trial = replace(trial, candidate=replace(trial.candidate, part=("mass",)))
    own = Unknowns(np.zeros(2), np.eye(2))
    rows = [replace(r, baseline=own) for r in equations.rows]
    described = replace(equations, rows=rows, evaluator=SimpleNamespace(arm=ARM))
    equations = equations.with_rows(rows)
    return significant(0, selected(equations, trial), described).passed


def stable(limits: Thresholds) -> Any:
    equations = known(limits)
    return _stable(0, selected(equations, law(equations, constant))).passed


# Extended


def split(limits: Thresholds) -> Any:
    """Drives whose inertia is split from the links', of which they have a fifth."""
    link = Inertial(3.0, (0.2, 0.0, 0.0), (0.01, 0.0, 0.0, 0.2, 0.0, 0.2))
    model = build_model(replace(ARM, links=(link, link)))
    equations = replace(real(limits), model=model)
    cause = Cause(valued(50.0, "joint_flexibility"), 50.0, 5.0, 5.0)
    system: Any = SimpleNamespace(base=np.full(len(model.grouping.base), 1.2))
    selection = Selection([cause], system, [])
    with patch.object(drive_inertia, "refound", return_value=selection):
        found, _, _ = drive_inertia.split_drive_inertia(selection, equations)
    return list(found)


def determined(limits: Thresholds) -> Any:
    """Which values of a law have a standard deviation."""
    equations = real(limits)
    trial = next(c for c in candidates(equations) if c.place == ("stribeck_friction", 1))
    found = Search(System(equations)).trial(trial)
    assert found is not None
    selection = selected(equations, found)
    spread = deviations(selection, equations)
    (estimates,) = cause_estimates(selection, equations, spread)
    return {name: bool(np.isfinite(estimate.std)) for name, estimate in estimates.items()}


def windows(limits: Thresholds) -> Any:
    """Number and length of the windows in which a record is simulated."""
    rows = real(limits).rows[0]
    fitted: Any = SimpleNamespace(model=SimpleNamespace(functions=()), parameters=None)
    with patch.object(extended_model, "simulated_windows") as simulated:
        extended_model.replay(fitted, rows, limits.extended)
    *_, starts, length = simulated.call_args.args
    return len(starts), length


# Experiment


def plan(limits: Thresholds, *, free: bool = False) -> Any:
    """An experiment for a cause that three others could stand for. free: nothing can be commanded."""
    equations = real(limits)
    names = ("friction_offset", "spring", "viscous_friction", "stribeck_friction")
    first, *rivals = [valued(50.0, name) for name in names]
    named: Any = SimpleNamespace(
        effect=first.candidate.effect, joint=1, aliases=(), ambiguous_with=[(n, 1, 1.0) for n in names[1:]]
    )
    cause = Cause(first, 50.0, 5.0, 5.0, [(t, 1.0) for t in rivals])
    system = System(equations)
    stage = None if free else setup(ARM, equations, system.base)
    with (
        patch.object(experiment, "propose", return_value=None),
        patch.object(experiment, "readings", return_value=[]),
        patch.object(experiment, "tests", return_value=[]),
    ):
        return next_experiment([named], [cause], stage, system, None)


def kept_from_limits(limits: Thresholds) -> Any:
    equations = real(limits)
    stage = setup(ARM, equations, System(equations).base)
    found = as_run(stage, problem(stage.arm, stage.settings(2500)), 0)
    return found is not None and float(np.abs(found[:, 1:]).sum())


def told_apart(limits: Thresholds) -> Any:
    """Whether a motion tells an offset from one with damping that depends on the direction."""
    equations = real(limits)
    system = System(equations)
    search = Search(system)
    members = []
    for name in ("friction_offset", "asymmetric_viscous_friction"):
        found = search.trial(Candidate(name, 1))
        assert found is not None
        members.append(hypothesis(found, limits.experiment))
    judge = Discriminator(system, equations, system.base)
    return np.isfinite(judge.evidence(members, equations.rows)).tolist()


CASES: dict[str, tuple[Value, Seen]] = {
    "candidates.min_refined_delta_bic": (-1e3, lambda t: searched(t, "stribeck_friction")),
    "candidates.wave_search_price": (50.0, lambda t: searched(t, "torque_ripple")),
    "validation.min_measured_share": (
        9.0,
        lambda t: gates(t.with_values({"validation.min_agreement": 2.0})).refused,
    ),
    "validation.max_rise": (-1.0, lambda t: gates(t).refused),
    "validation.min_power_share": (0.9, faint_in_one),
    "validation.position_error_factor": (1e3, lambda t: gates(t, repeat=False, blur=0.02).refused),
    "validation.min_instrument_deviations": (1e3, by_instruments),
    "validation.max_records_one_by_one": (2, lambda t: gates(t, count=4).gain),
    "selection.min_whole_arm_share": (0.4, of_all_joints),
    "selection.max_sign_deviations": (1e3, impossible),
    "selection.max_refit_growth": (0.1, anew),
    "selection.max_causes": (9, turns),
    "selection.max_causes_per_joint": (9, turns),
    "adequacy.max_alias_angle": (2.0, equal),
    "adequacy.min_absorbed_share": (2.0, absorbed),
    "adequacy.max_behind_refused": (30.0, dominated),
    "adequacy.max_apart_ahead": (1e6, at_both_joints),
    "adequacy.max_pace_share": (1e6, at_any_pace),
    "adequacy.slow_rows_share": (0.01, lambda t: elastic_while(t, slow=True).ahead),
    "adequacy.min_clear_evidence": (1e6, lambda t: freely(t, constant)),
    "adequacy.min_evidence_in_noise": (1e6, left_beside),
    "adequacy.min_claimed_deviations": (1e3, claimed),
    "adequacy.min_stable_probability": (2.0, stable),
    "extended.min_inertia_share": (0.4, split),
    "extended.max_relative_deviation": (1e9, determined),
    "extended.simulated_window": (1.0, windows),
    "extended.max_windows": (3, windows),
    "experiment.max_members": (2, lambda t: len(plan(t).members)),
    "experiment.periods": (7, lambda t: plan(t, free=True).run),
    "experiment.limit_margin": (0.3, kept_from_limits),
    "experiment.min_left_share": (2.0, told_apart),
}
