"""Parameters of models whose regressor depends on what is looked for: friction grows with the load, or joints
are elastic.

With columns at the load of the fit before, gravity that is known badly, beside a spring say, ends in the
wrong friction with a small deviation. By Gauss's and Newton's steps the load's own change with the parameters
has its part in the columns (Bates and Watts 1988, 2.2), and in the deviations.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from modelgen.dataset import Prepared
from modelgen.evaluation import Evaluator, Motion
from modelgen.evaluation.link_encoder import compliant
from modelgen.functions import Model
from modelgen.identification.rows import motion_of
from modelgen.numeric import Array
from modelgen.regression.least_squares import Regression, Solution

# Budgets: how finely the fit ends decides nothing.
TURNS = 12
HALVINGS = 4
LEAST_GAIN = 1e-4  # of the misfit, beneath which a step is the last
TOUCH = 1e-3  # of a parameter, by which it is moved to see what the columns do
LEAST = 1e-9  # of its own unit

At = Callable[[Array], Regression]  # rows with the columns at base parameters (p,)


def fitted_by_load(
    at: At, slopes: Callable[[Array], Sequence[Array]], first: Solution, method: str
) -> tuple[Regression, Solution]:
    """Rows and parameters where no step leaves less, from `first` on.

    slopes: at base parameters (p,), what a change of each does to the columns, times the parameters, (M, n,
    p) of each record. The columns given back are those of the last step, the efforts as they are explained
    by these.
    """
    theta = first.theta
    here = at(theta)
    least = _misfit(here, theta)
    for turn in range(TURNS):
        more = slopes(theta)
        linear = replace(
            here,
            effort=[y + d @ theta for y, d in zip(here.effort, more, strict=True)],
            columns=[c + d for c, d in zip(here.columns, more, strict=True)],
        )
        found = linear.solve(method)
        if turn == TURNS - 1:
            break
        for half in range(HALVINGS):
            tried = theta + (found.theta - theta) / 2**half
            there = at(tried)
            value = _misfit(there, tried)
            if value < least:
                break
        else:
            break
        gained, theta, here, least = least - value, tried, there, value
        if gained < LEAST_GAIN:
            break
    return linear, replace(found, theta=theta)


def _misfit(regression: Regression, theta: Array) -> float:
    """What weighted least squares makes least: half the logarithms of the joints' mean squares, by rows."""
    residuals, total, count = regression.residuals(theta), 0.0, 0.0
    for j in range(regression.effort[0].shape[1]):
        left = np.concatenate([e[m[:, j], j] for e, m in zip(residuals, regression.moving, strict=True)])
        if len(left):
            total += len(left) * 0.5 * float(np.log(max(np.mean(left**2), 1e-300)))
            count += len(left)
    return total / max(count, 1.0)


def slopes_of(
    evaluator: Evaluator, model: Model, records: Sequence[Prepared], added: Sequence[Array], theta: Array
) -> list[Array]:
    """`slopes` of `fitted_by_load` at the rows, by differences. What the filter does to them is left out, but
    where elastic joints swing, or a law has a state.
    """
    found, every = [], compliant(model.arm) or model.function("regressor").reads("state")
    for p, more in zip(records, added, strict=False):
        motion = motion_of(p) if every else motion_of(p).picked(p.rows)
        whole = theta + more
        efforts = partial(_efforts, evaluator, model, motion, whole)
        before = efforts(whole)
        table = np.zeros((*before.shape, len(theta)))
        # A state that follows from the motion alone stays as it is.
        moves = bool((efforts(whole * (1.0 + TOUCH) + LEAST) != before).any())
        for k, value in enumerate(theta if moves else ()):
            step = max(TOUCH * abs(float(value)), LEAST)
            moved = whole + step * (np.arange(len(theta)) == k)
            table[:, :, k] = (efforts(moved) - before) / step
        found.append(p.parallel(table * p.weights[:, :, None]) if every else table)
    return found


def _efforts(evaluator: Evaluator, model: Model, motion: Motion, theta: Array, at: Array) -> Array:
    """Efforts (N, n) of parameters theta (p,), with the columns, and what elastic joints add, at others."""
    columns = np.asarray(evaluator.regressor(model, motion, at))
    return columns @ theta + evaluator.unseen(motion, columns, at)
