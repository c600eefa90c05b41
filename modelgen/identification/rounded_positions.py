"""What the rounding of positions does to parameters: accelerations of coarse counts make inertias smaller."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modelgen.dataset import Prepared, Record, drives_of, prepare
from modelgen.dataset.processing.content import quiet_speeds
from modelgen.dataset.processing.filters import low_pass
from modelgen.dataset.processing.rounding import position_steps
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.identification.validation import regression_of
from modelgen.numeric import Array
from modelgen.regression.least_squares import Regression, Solution

DRAWS = 2  # of further roundings, each the cost of a fit


def with_rounded_positions(
    solution: Solution,
    regression: Regression,
    train: Sequence[Prepared],
    model: Model,
    evaluator: Evaluator,
    added: Sequence[Array] | None,
) -> Solution:
    """The solution with what rounding of the positions adds to its covariance.

    Errors of the regressor move parameters one way, however many rows there are. The smoothed positions are
    rounded once more, at other places of their steps, and fitted like the log's: the parameters move about
    as far again (Cook and Stefanski 1994).
    """
    if not any(position_steps(p.record).any() for p in train):
        return solution
    first, moves = regression.as_in(solution).least_squares(), list[Array]()
    for seed in range(DRAWS):
        again = [prepared_anew(p, seed) for p in train]
        rows = regression_of(evaluator, model, again, solution.theta, added)
        found = replace(rows, moving=regression.moving).as_in(solution).least_squares()
        moves.append((found - first) / np.sqrt(DRAWS))
    return solution.uncertain_by(moves)


def _motion(p: Prepared) -> Array:
    """Positions (N, n) in which no steps are seen: another rounding of those would be the log's, moved."""
    quiet, own = quiet_speeds(p.record, p.settings.thresholds), p.settings.position_cutoff
    if 0.0 < own <= quiet or np.isinf(quiet):
        return p.q.copy()
    return low_pass(p.record.q, quiet, 1.0 / p.record.step, p.settings.position_order)


def prepared_anew(p: Prepared, seed: int) -> Prepared:
    """The record with its positions rounded once more, prepared alike: joints rest where they did, and it
    runs on from what it did.
    """
    return replace(prepare(rounded_anew(p, seed), p.settings), awake=p.awake, before=p.before)


def rounded_anew(p: Prepared, seed: int) -> Record:
    """The record with its smoothed positions rounded once more, at other places of the steps."""
    random, record = np.random.default_rng(seed), p.record
    q, motor = _motion(p), p.motor.copy()
    drives = drives_of(record.arm) if record.arm is not None else ()
    for k, step in enumerate(position_steps(record)):
        if step:
            place = step * random.uniform()
            q[:, k] = step * np.rint((q[:, k] + place) / step) - place
            motor[:, k] = drives[k].motor(q[:, k]) if drives else q[:, k]
    return replace(record, q=q, motor=motor)
