"""The model as described and the extended one, fitted, and what either leaves of the test record."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from modelgen.dataset import Prepared, prepare
from modelgen.description import Arm
from modelgen.diagnosis.candidates import beyond_bounds
from modelgen.diagnosis.equations import Equations, Rows, Unknowns, estimated, held, rows_of, settled_rows
from modelgen.diagnosis.extended.cause_values import as_fitted, bounded_fit, own_parameters, valued
from modelgen.diagnosis.extended.drive_inertia import split_drive_inertia
from modelgen.diagnosis.extended.findings import Estimate
from modelgen.diagnosis.options.thresholds import ExtendedThresholds
from modelgen.diagnosis.selection import Selection, beside_hidden_weight, refit_elastic
from modelgen.effects import CATALOGUE, Family, applied_effects, described
from modelgen.effects.placement import extended_arm, titled
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.functions import EVALUATED, Model, build_model
from modelgen.numeric import Array
from modelgen.regression.weighted import misfit, weighted_fit
from modelgen.simulation.windows import Windows, simulated_release, simulated_windows

# Budgets of fits beside elastic joints and friction by the load: how finely these end decides nothing.
HALVES = 10  # steps, of which half is taken each
WHOLES = 6  # steps by the slopes
SHORTER = 3  # times a step is halved that leads astray
TOUCH = 1e-4  # of a parameter
LEAST = 1e-7  # of its own unit


@dataclass(frozen=True)
class FittedModel:
    """A model fitted to the training records. theta: (k,) unknowns of the rows' baseline."""

    arm: Arm
    model: Model
    rows: Sequence[Rows]
    theta: Array

    @property
    def parameters(self) -> Array:
        """Base parameters (p,)."""
        return self.rows[0].baseline.base(self.theta)


@dataclass(frozen=True)
class Extension:
    """The model as described, and the extended one.

    selection: the causes with their values as reported. equations: of the arm with those inertias of its
    drives that were split from their links'. base: its base parameters (p,) as found beside the causes.
    inertias: by coordinate (from 1).
    """

    selection: Selection
    equations: Equations
    base: Array
    inertias: Mapping[int, Estimate]
    before: FittedModel
    after: FittedModel


def extend(arm: Arm, selection: Selection, equations: Equations) -> Extension:
    """Refit the causes' values beside the arm's parameters; fit the arm as described and with the causes."""
    base = selection.system.base
    inertias, selection, split = split_drive_inertia(selection, equations)
    selection = valued(beside_hidden_weight(refit_elastic(selection, split)))
    _check(arm, selection)
    before = fitted(arm, equations.model, equations.rows)
    after = extended(before, selection, split)
    selection = as_fitted(selection, after.model, after.parameters)
    return Extension(selection, split, base, inertias, before, after)


def _check(arm: Arm, selection: Selection) -> None:
    """Raises InputError where a cause that passed has no value that an arm can have beside all the rest."""
    for trial in (c.trial for c in selection.causes):
        for p in beyond_bounds(trial):
            name, (low, high) = titled(arm, *trial.candidate.place), p.bounds
            raise InputError(
                f"{arm.name}: beside all others, {name} comes out with a value that no arm has ({p.name} may "
                f"be {low:g} to {high:g}); are signs and units of the efforts, ratio and torque_constant "
                "right?"
            )


def fitted(arm: Arm, model: Model, rows: Sequence[Rows]) -> FittedModel:
    """The model with the parameters that explain the rows best."""
    return FittedModel(arm, model, rows, weighted_fit(rows, [r.columns for r in rows]))


def extended(before: FittedModel, selection: Selection, equations: Equations) -> FittedModel:
    """The equations' arm with the causes, everything else fitted anew."""
    causes = [(*c.trial.candidate.place, c.trial.parameters) for c in selection.causes]
    if not causes:
        return before
    bigger = extended_arm(equations.arm, causes)
    model = build_model(bigger, EVALUATED)
    known = held(model) if equations.free else estimated(model, equations.thresholds.equations)
    # links that weigh nothing swing on no spring: not from zero
    beside = zip(before.model.grouping.base, selection.system.base, strict=True)
    values = {b.name: value for b, value in beside}
    first = np.array([values.get(b.name, 0.0) for b in model.grouping.base])
    start = None if equations.free else first
    seen = [seen_by(r.prepared, bigger) for r in equations.rows]
    if any(CATALOGUE[effect].family is Family.ELASTIC for effect, _, _ in causes):
        rigid = misfit(before.rows, [r.columns for r in before.rows], before.theta)
        return FittedModel(bigger, model, *settled(bigger, model, seen, known, first, rigid))
    bounds = [*own_parameters(model, [c.trial for c in selection.causes])]
    own = settled_rows(Evaluator(bigger), model, seen, known, start)
    if not equations.free and any(e.depends_on("load") for e in applied_effects(bigger)):
        search = _Search(Evaluator(bigger), model, seen, known)
        search.at(weighted_fit(own, [r.columns for r in own]))
        theta = bounded_fit(search.stepped(), bounds)
        rows = _as_there(search.at(theta)[0], before, selection, equations, theta)
        if all(a is b for a, b in zip(rows, search.last, strict=True)):
            return FittedModel(bigger, model, rows, theta)
        return FittedModel(bigger, model, rows, bounded_fit(rows, bounds))
    rows = _as_there(own, before, selection, equations, start)
    return FittedModel(bigger, model, rows, bounded_fit(rows, bounds))


def _as_there(
    own: Sequence[Rows], before: FittedModel, selection: Selection, equations: Equations, start: Array | None
) -> list[Rows]:
    """The equations of the records, without those causes that are not in one; `own` where all are there."""
    trials, found = [c.trial for c in selection.causes], list(own)
    for k, rows in enumerate(own):
        there = [t for t in trials if k not in t.candidate.absent]
        if len(there) == len(trials):
            continue
        if not there:
            less = before.rows[k]
        else:
            arm = extended_arm(equations.arm, [(*t.candidate.place, t.parameters) for t in there])
            model = build_model(arm, EVALUATED)
            known = held(model) if equations.free else estimated(model, equations.thresholds.equations)
            (less,) = settled_rows(Evaluator(arm), model, [seen_by(rows.prepared, arm)], known, start)
        if less.columns.shape == rows.columns.shape:
            found[k] = less
    return found


def without(extension: Extension, there: Sequence[bool]) -> FittedModel:
    """The extended model without the causes that are not there; its parameters are those of the arm without
    them. there: of each cause.
    """
    after, causes = extension.after, extension.selection.causes
    if all(there):
        return after
    kept = [(*c.trial.candidate.place, c.trial.parameters) for c, so in zip(causes, there, strict=True) if so]
    arm = extended_arm(extension.equations.arm, kept) if kept else extension.before.arm
    model = build_model(arm, EVALUATED)
    alike = len(model.grouping.base) == len(after.parameters)
    return replace(after, arm=arm, model=model) if alike else after


def seen_by(prepared: Prepared, arm: Arm) -> Prepared:
    """The record as this arm reads it: its levers make other angles of the same motor coordinates."""
    record = prepared.record
    if not any(CATALOGUE[u.name].rereads for j in arm.joints for u in j.effects) or not any(
        record.motor_side
    ):
        return prepared
    again = prepare(replace(record, arm=described(arm)), prepared.settings)
    return replace(again, before=prepared.before)


def replay(fitted: FittedModel, rows: Rows, limits: ExtendedThresholds) -> Windows | None:
    """Simulated against measured positions; None where the record is too short, or nothing stays finite.

    A free motion has no inputs, and is simulated from its beginning to its end, from the start that fits it.
    """
    p = rows.prepared
    trim = int(p.rows[0])
    if p.input is None:
        moving = np.flatnonzero(rows.moving.any(axis=1))
        if not len(moving):
            return None
        starts = p.rows[moving[:1]]
        length = len(p.time) - trim - int(starts[0])
    else:
        length = max(4, round(limits.simulated_window / p.record.step))
        count = (len(p.time) - 2 * trim) // length
        if count < 2:
            return None
        starts = trim + length * np.linspace(0, count - 1, min(count, limits.max_windows)).astype(int)
    states = None
    if any(f.name == "effects_step" for f in fitted.model.functions):
        evaluator = Evaluator(fitted.arm)
        states = evaluator.states(rows.motion, fitted.parameters)
        moved = evaluator.link_side.at_drives(
            rows.motion, fitted.parameters
        )  # what the model's coordinates are
        p = replace(p, q=moved.q, dq=moved.dq, ddq=moved.ddq)
    if p.input is None:
        return simulated_release(fitted.model, fitted.parameters, states, p, int(starts[0]), length)
    return simulated_windows(fitted.model, fitted.parameters, states, p, starts, length)


def unit_of_efforts(test: Prepared) -> str:
    """Unit of the log's efforts; several where joints differ."""
    return ", ".join(dict.fromkeys(test.effort_unit)) or "A"


def settled(
    arm: Arm, model: Model, train: Sequence[Prepared], known: Unknowns, theta: Array, rigid: float
) -> tuple[list[Rows], Array]:
    """Equations of the records at the unknowns (k,) that explain most, and these. rigid: `misfit` without the
    joints.

    At first what the joints do is held while the arm's parameters are fitted beside it, over and over. A soft
    joint answers little of these with much: where that finds nothing better than a rigid arm, Gauss's and
    Newton's steps follow, by differences.
    """
    search = _Search(Evaluator(arm), model, train, known)
    for _ in range(HALVES):
        rows, _ = search.at(theta)
        theta = (theta + weighted_fit(rows, [r.columns for r in rows])) / 2
    if search.least >= rigid:
        search.stepped()
    return search.rows, search.theta


class _Search:
    """Keeps the best of all unknowns that were tried."""

    def __init__(
        self, evaluator: Evaluator, model: Model, train: Sequence[Prepared], known: Unknowns
    ) -> None:
        self.evaluator, self.model, self.train, self.known = evaluator, model, train, known
        self.rows: list[Rows] = []
        self.theta, self.least = np.zeros(0), np.inf
        self.last: list[Rows] = []

    def at(self, theta: Array) -> tuple[list[Rows], float]:
        """Equations there, and their misfit."""
        rows = [rows_of(self.evaluator, self.model, p, theta, self.known) for p in self.train]
        left = misfit(rows, [r.columns for r in rows], theta)
        if not self.rows or left < self.least:
            self.rows, self.theta, self.least = rows, theta, left
        self.last = rows
        return rows, left

    def stepped(self) -> list[Rows]:
        """Go on from the best by Gauss's and Newton's steps until none explains more; `linearised` there."""
        for _ in range(WHOLES):
            least, theta = self.least, self.theta
            rows = self.linearised()
            step = weighted_fit(rows, [r.columns for r in rows]) - theta
            if not any(self.at(theta + step / 2**k)[1] < least for k in range(SHORTER + 1)):
                return rows
        return self.linearised()

    def linearised(self) -> list[Rows]:
        """Equations at the best, with what each unknown changes for its column."""
        found = []
        for r in self.rows:
            here, columns = self.evaluator.inputs(r.motion, self.known.base(self.theta)), []
            for k, value in enumerate(self.theta):
                step = max(TOUCH * abs(value), LEAST)
                moved = self.theta + step * (np.arange(len(self.theta)) == k)
                columns.append((self.evaluator.inputs(r.motion, self.known.base(moved)) - here) / step)
            table = r.filtered(np.stack(columns, axis=2))
            found.append(replace(r, effort=r.effort + (table - r.columns) @ self.theta, columns=table))
        return found
