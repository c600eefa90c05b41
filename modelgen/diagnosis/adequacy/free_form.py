"""Whether a function of no law, or a law that is not one of several joints, explains as much as the causes.

At a joint the functions are of its position and speed, of another joint's beside them, of what the joint
did before, or of the time; Gaussian processes with a jump where the speed changes its sign (Rasmussen and
Williams 2006): whatever a friction or a force over these does, one of them can. A law that is there
explains as much at the price of its few parameters; one that is not ahead of the functions has only their
shape for itself. A law that acts on several joints says how much on each: where each has a size of its
own, it is not the law. What bends or has play acts wherever its load changes: if it explains only rows at
which its joint nearly rests, what is there is a form of friction. And an encoder's error that repeats with
each turn of its shaft may do what they do.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from modelgen.diagnosis.adequacy.encoder_errors import of_encoder
from modelgen.diagnosis.adequacy.motion_functions import (
    of_gain,
    of_late,
    of_others,
    of_state,
    of_way,
    of_when,
)
from modelgen.diagnosis.adequacy.smooth_functions import (
    SmoothFunction,
    Worth,
    log_evidence,
    of_pose,
    spots,
)
from modelgen.diagnosis.candidates import FittedCandidate, beside, candidate_columns, system_of
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.evidence import System
from modelgen.diagnosis.selection import Selection, beside_hidden_weight, threshold, together
from modelgen.effects import Family
from modelgen.numeric import Array

SLOW_ROWS = 3.0  # rows over which a column is evened: an eighth of the cut-off


@dataclass(frozen=True)
class FreeForm:
    """ahead: delta BIC by which what has no law is ahead of the causes at a joint, or of the whole arm; most:
    by which it may be. apart: it is the law itself, with a size of its own at every joint, or record; slow:
    nothing, while the joint is not at its slowest, so that `ahead` is the evidence that the cause has there,
    below zero. pace: it is the law itself, with a size of its own in slow motion. error: it is an error of an
    encoder. what: which error, else what the function is of.
    """

    ahead: float
    most: float
    what: str = ""
    apart: bool = False
    pace: bool = False
    slow: bool = False
    error: bool = False

    @property
    def beyond(self) -> float:
        """Delta BIC by which it is farther ahead than it may be."""
        return self.ahead - self.most

    @property
    def as_good(self) -> bool:
        """Whether nothing speaks for the laws that the function does not have."""
        return self.ahead > self.most


def free_forms(
    selection: Selection,
    equations: Equations,
    terms: Mapping[int, Worth],
    suspects: Sequence[FittedCandidate] = (),
) -> dict[int | None, FreeForm]:
    """Find, for each joint with causes, the free function that is ahead of them by most, and for it and the
    whole arm by how much their own laws are with a size at every joint.

    Asked for all causes of a joint together; a cause whose law is the first terms of a series counts with the
    function that the series would come to. The laws of elastic joints and play are none of the joint's
    motion: at their joints it is asked what they explain while these are not at their slowest. Not of free
    motions. terms: by joint, see `further_terms`. suspects: what was found beside the causes, and has failed:
    errors of the encoders at its joints may do what these do.
    """
    if equations.free:
        return {}
    limits = equations.thresholds.adequacy
    most = 0.0 if selection.system.noise_known else limits.min_clear_evidence
    every = [*(c.trial for c in selection.causes), *suspects]
    joints = {j - 1 for t in every if (j := t.candidate.joint) is not None}
    errors = [shape for j in sorted(joints) for shape in of_encoder(j, selection.system)]
    found: dict[int | None, FreeForm] = {}
    for joint in {c.trial.candidate.joint: None for c in selection.causes}:
        own = [c.trial for c in selection.causes if c.trial.candidate.joint == joint]
        elastic = [t for t in own if t.candidate.elastic]
        others = [c.trial for c in selection.causes if c.trial.candidate.joint != joint]
        without = system_of(equations, others, selection.system)
        if elastic and joint is not None:
            slow = (_slowest_out(t, joint - 1, selection) for t in elastic)
            slowest = max(slow, key=lambda form: form.ahead)
            found[joint] = _or_misread(slowest, errors, own, without, most)
            continue
        found[joint] = further_form(own, without)
        if joint is None:
            found[joint] = max(found[joint], _of_pose(selection, most), key=lambda form: form.beyond)
            continue
        rest = 0.0  # of the series, which is no other cause
        if any(t.candidate.definition.series for t in own):
            rest = max(rest, terms[joint].evidence)
        inputs = [equations.evaluator.inputs(r.motion, without.base) for r in equations.rows]
        further = spots(joint - 1, equations), of_late(joint - 1, equations)
        by_inputs = [f for of in (of_gain, of_when) for f in of(joint - 1, equations, inputs)]
        shapes = [*shapes_at(joint - 1, equations), *further, *by_inputs]
        by, shape = ahead(shapes, own, without)
        free = FreeForm(by - rest, most, what=shape.text)
        form = max(free, found[joint], key=lambda form: form.beyond)
        found[joint] = _or_misread(form, errors, own, without, most)
    return found


def _or_misread(
    form: FreeForm,
    errors: Sequence[SmoothFunction],
    own: Sequence[FittedCandidate],
    without: System,
    most: float,
) -> FreeForm:
    """The form, or an error of an encoder that is ahead of the causes at its joint by more than `most`, and
    so of the form where that is ahead of them too. without: the system of the others.
    """
    if not errors:
        return form
    by, error = ahead(errors, own, without)
    best = FreeForm(by, most, what=error.text, error=True)
    known = form.as_good and form.ahead + most >= best.ahead
    return best if best.as_good and not known else form


def _slowest_out(trial: FittedCandidate, j: int, selection: Selection) -> FreeForm:
    """Evidence of an elastic joint or play, below zero, without the rows at which its joint j (from 0) is
    slowest.
    """
    equations = selection.system.equations
    speeds = [np.abs(r.prepared.picked(r.prepared.dq)[:, j]) for r in equations.rows]
    moving = [x[r.moving[:, j]] for x, r in zip(speeds, equations.rows, strict=True)]
    least = np.quantile(np.concatenate(moving), equations.thresholds.adequacy.slow_rows_share)
    kept = []
    for r, speed in zip(equations.rows, speeds, strict=True):
        flags = r.moving.copy()
        flags[:, j] &= speed >= least
        kept.append(replace(r, moving=flags))
    faster = equations.with_rows(kept)
    others = [c.trial for c in selection.causes if c.trial is not trial]
    gain = beside(trial, system_of(faster, others))
    evidence = -np.inf if gain is None else gain.delta_bic
    return FreeForm(-evidence, -threshold(selection.system), slow=True)


def further_form(own: Sequence[FittedCandidate], without: System) -> FreeForm:
    """Delta BIC by which causes are ahead of themselves with a size of their own at each joint that they act
    on; what some records have, with one in each record; a delay, with one for slow motion. Those that act on
    several joints by the law of a fluid, of which arms differ, or by what is a guess, keep one size.

    own: of a joint, or of the whole arm; without: the system of the others.
    """
    most, alone = without.equations.thresholds.adequacy.max_apart_ahead, together(own, without, fair=True)
    columns = [_by_record(t, without) if t.candidate.coming else _by_joint(t) for t in own]
    found = [FreeForm(-np.inf, most, apart=True)]
    if any(split is not t.columns for split, t in zip(columns, own, strict=True)):
        beside = [np.concatenate(tables, axis=2) for tables in zip(*columns, strict=True)]
        gain = without.fair.gain(beside, float(sum(len(t.values) for t in own)), ())
        if gain is not None:
            found.append(FreeForm(gain.delta_bic - alone, most, apart=True))
    found += [_slowly(t, without) for t in own if t.delay is not None]
    return max(found, key=lambda form: form.beyond)


def _slowly(delay: FittedCandidate, without: System) -> FreeForm:
    """Delta BIC of a further delay in slow motion alone, beside parameters that are found there.

    A disturbance that the controller answers passes for a delay at its own frequencies, and bends the arm's
    parameters by what it has there.
    """
    equations, limits = without.equations, without.equations.thresholds.adequacy
    tables, beside = ([_evened(t) for t in columns] for columns in (delay.columns, without.columns))
    rows = [
        replace(r, effort=_evened(r.effort), columns=_evened(r.columns), moving=_within(r.moving))
        for r in equations.rows
    ]
    if not any(r.moving.any() for r in rows):
        return FreeForm(-np.inf, limits.max_apart_ahead, pace=True)
    slow = System(equations.with_rows(rows), beside)
    whole = slow.fair.gain(tables)
    late = [replace(r, effort=r.effort - t @ delay.gain.values) for r, t in zip(rows, tables, strict=True)]
    further = System(equations.with_rows(late), beside).fair.gain(tables)
    if whole is None or further is None:
        return FreeForm(-np.inf, limits.max_apart_ahead, pace=True)
    most = max(limits.max_apart_ahead, limits.max_pace_share * whole.delta_bic)
    return FreeForm(further.delta_bic, most, pace=True)


def _within(moving: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Flags (M, n) of the rows that move with those around them: what is left out at a rest is slow too."""
    around = np.ones((2 * round(2.0 * SLOW_ROWS) + 1, 1))
    return np.asarray(ndimage.binary_erosion(moving, around))


def _evened(values: Array) -> Array:
    """Rows (M, ...) of a record, of what is slow in them."""
    return np.asarray(ndimage.gaussian_filter1d(values, SLOW_ROWS, axis=0, mode="nearest"))


def _of_pose(selection: Selection, most: float) -> FreeForm:
    """Delta BIC by which functions of where the arm is, one at each joint, are ahead of all causes together.

    A pull at the arm looks like a tilt, a constant force at a joint and other lengths of a lever together.
    """
    selection = beside_hidden_weight(selection)
    equations = selection.system.equations
    nothing = system_of(equations, [], selection.system)
    lengths = equations.thresholds.adequacy.bend_lengths
    worth = [[log_evidence(f, nothing).evidence for f in of_pose(equations, bend)] for bend in lengths]
    best = sum(max(0.0, *at_joint) for at_joint in zip(*worth, strict=True))
    own = [c.trial for c in selection.causes]
    return FreeForm(best - together(own, nothing, fair=True), most, "where the arm is, one at each joint")


def _by_joint(trial: FittedCandidate) -> Sequence[Array]:
    """Columns (M, n, k) of every record; of a law that acts on several joints (M, n, m k), by joint."""
    c = trial.candidate
    acts = np.any([t.any(axis=(0, 2)) for t in trial.columns], axis=0)
    if acts.sum() < 2 or c.definition.family is Family.FLUID or c.elastic:
        return trial.columns
    places = np.eye(len(acts))[acts]
    return [np.concatenate([t * place[:, None] for place in places], axis=2) for t in trial.columns]


def _by_record(trial: FittedCandidate, without: System) -> Sequence[Array]:
    """Columns of what some records have, (M, n, (r - 1) k) with a size of its own in each but one."""
    every = replace(trial.candidate, absent=frozenset())
    made = candidate_columns(every, {**trial.values, **trial.around}, without.equations, without.base)
    if made is None or len(made) < 3:  # two records differ in one way
        return trial.columns
    places = np.eye(len(made))[:, 1:]
    return [np.concatenate([t * x for x in place], axis=2) for t, place in zip(made, places, strict=True)]


def shapes_at(j: int, equations: Equations) -> Iterator[SmoothFunction]:
    """Functions of no law of what a force at joint j (from 0) may depend on, but spots and of when."""
    yield from of_state(j, equations)
    yield from of_others(j, equations)
    yield of_way(j, equations)


def ahead(
    shapes: Iterable[SmoothFunction], own: Sequence[FittedCandidate], without: System
) -> tuple[float, SmoothFunction]:
    """Delta BIC by which the best of these functions is ahead of all causes `own`, beside the others; which.

    without: the system of the others, with the noise that all causes leave: what they explain is none.
    """
    worth = [(log_evidence(shape, without).evidence, shape) for shape in shapes]
    best, shape = max(worth, key=lambda one: one[0])
    return best - together(own, without, fair=True), shape


def further_terms(selection: Selection) -> dict[int, Worth]:
    """Find, for each joint with a law that is the first terms of a series, what further ones are worth.

    Beside all causes, of the functions of the joint's position times its direction the best one. None of a
    free motion.
    """
    system = selection.system
    joints = {c.trial.candidate.joint for c in selection.causes if c.trial.candidate.definition.series}
    if system.equations.free:
        return {}
    return {
        joint: max(
            (log_evidence(shape, system) for shape in of_state(joint - 1, system.equations, series=True)),
            key=lambda worth: worth.evidence,
        )
        for joint in sorted(j for j in joints if j is not None)
    }
