"""Equations of one record: effort and regressor through one filter, sample by sample and joint by joint."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset import Prepared
from modelgen.dataset.couplings import Coupling, couplings_of
from modelgen.dataset.processing.rest import moving_samples
from modelgen.description import Arm
from modelgen.diagnosis.equations.prior import Unknowns
from modelgen.evaluation import Evaluator, Motion
from modelgen.functions import Model
from modelgen.numeric import Array

__all__ = ["Array", "Rows", "rows_of"]


@dataclass(frozen=True)
class Rows:
    """M rows of n joints. effort: (M, n) as the model has its inputs, less what is known of them; columns:
    (M, n, p), one for each unknown of the baseline; moving: (M, n), rows that count. repeated: (M, n), a draw
    of what rounded readings leave in the residuals, if that repeats with the motion; None if nothing does.
    """

    prepared: Prepared
    effort: Array
    columns: Array
    moving: NDArray[np.bool_]
    baseline: Unknowns
    repeated: Array | None = None

    @cached_property
    def motion(self) -> Motion:
        """Motion at full rate."""
        return motion_of(self.prepared)

    @property
    def gain(self) -> Array:
        """Factor from an input to what the log carried, (M, n)."""
        p = self.prepared
        return np.ones(self.effort.shape) if p.gain is None else np.asarray(p.gain[p.rows])

    def filtered(self, columns: Array) -> Array:
        """(N, n, k) at full rate through the parallel filter: (M, n, k). What is zero stays so."""
        result = np.zeros((len(self.effort), *columns.shape[1:]))
        # one by one: most have something at once, and are then not read to their ends
        flat = columns.reshape(len(columns), -1)
        used = np.array([x.any() for x in flat.T], dtype=bool).reshape(columns.shape[1:])
        if used.any():
            result[:, used] = self._through(columns[:, used], np.nonzero(used)[0])
        return result

    def equation(self, j: int, columns: Array) -> Array:
        """Columns (N, k) of the equation of joint j at full rate through the parallel filter: (M, k)."""
        return self._through(columns, np.full(columns.shape[1], j))

    def _through(self, columns: Array, joints: NDArray[np.intp]) -> Array:
        """Columns (N, k) of the equations of these joints (k,) through the parallel filter: (M, k).

        Without what they have while the joint rests: dry friction is undetermined there, and what the filter
        carries of it to the rows beside would look like a law of friction.
        """
        with np.errstate(over="ignore", invalid="ignore"):  # states of a law that does not hold here
            return self.prepared.parallel(columns * self.prepared.weights[:, joints])


def motion_of(prepared: Prepared) -> Motion:
    """Motion at full rate, with the side of the joints that was measured."""
    p = prepared
    sides = p.record.motor_side or (False,) * p.n
    before = None if p.before is None else motion_of(p.before)
    return Motion(p.time, p.q, p.dq, p.ddq, sides, p.settings.cutoff, before, p.record.held)


def rows_of(
    evaluator: Evaluator,
    model: Model,
    prepared: Prepared,
    theta: Array | None,
    baseline: Unknowns,
) -> Rows:
    """The equations of a record. theta: unknowns, for what of the regressor depends on them (loads).

    A free motion has no effort: its equations are 0 = regressor parameters.
    """
    known = baseline
    parameters = known.base(np.zeros(known.lift.shape[1]) if theta is None else theta)
    motion = motion_of(prepared)
    columns = evaluator.regressor(model, motion, parameters)
    given = np.zeros(prepared.q.shape) if prepared.input is None else prepared.input
    effort = evaluator.ideal(model, motion, given) - evaluator.unseen(motion, columns, parameters)
    if known.fixed.any() or known.lift.shape[0] != known.lift.shape[1]:
        effort = effort - columns @ known.fixed
        columns = columns @ known.lift
    moving = prepared.moving & of_arm(evaluator.arm, prepared)
    empty = Rows(prepared, np.zeros((len(prepared.rows), prepared.n)), np.zeros(0), moving, known)
    effort, columns = empty.filtered(effort[:, :, None])[:, :, 0], empty.filtered(columns)
    # states of a law that does not hold along this motion may leave all bounds
    good = np.isfinite(effort) & np.isfinite(columns).all(axis=2)
    if good.all():
        return Rows(prepared, effort, columns, moving, known)
    effort, columns = np.where(good, effort, 0.0), np.where(good[:, :, None], columns, 0.0)
    return Rows(prepared, effort, columns, moving & good, known)


def turning(prepared: Prepared, joint: int, other: int, ratio: float) -> NDArray[np.bool_]:
    """(M, n), rows at which a coupling moves, as far as the equations of its two joints are concerned.

    joint, other: numbers of the coordinates, from 1; ratio: turns of the first per turn of the other.
    """
    return _turning(Coupling(joint - 1, other - 1, ratio), prepared)


def _turning(part: Coupling, prepared: Prepared) -> NDArray[np.bool_]:
    own = replace(prepared.settings, rest_speeds=(part.gate(prepared.settings.rest_speeds),))
    speed, rate = part.speed(prepared.dq), 1.0 / prepared.record.step
    found = np.ones((len(prepared.rows), prepared.n), dtype=bool)
    found[:, [part.one, part.other]] = moving_samples(speed, prepared.rows, own, rate)
    return found


def of_arm(arm: Arm, prepared: Prepared) -> NDArray[np.bool_]:
    """(M, n), rows at which all couplings of the arm's description move; all of a free motion."""
    found = np.ones((len(prepared.rows), prepared.n), dtype=bool)
    if prepared.input is None:
        return found
    for part in couplings_of(arm):
        found &= _turning(part, prepared)
    return found
