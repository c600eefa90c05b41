"""Causes in proportion to the load, fitted together with the parameters that the load follows from.

Columns anew at the parameters found with those before come to an end where gravity is known well. Beside a
spring it is not, and the friction ends far off: there the load's own change with the parameters has its part
in their columns, by Gauss's and Newton's steps (Bates and Watts 1988, 2.2).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from modelgen.diagnosis.candidates import (
    Candidate,
    FittedCandidate,
    candidate_columns,
    columns_at_rows,
    unchanging,
    with_causes,
)
from modelgen.diagnosis.equations import Equations, Rows
from modelgen.diagnosis.selection.cause import Cause
from modelgen.numeric import Array
from modelgen.regression.weighted import misfit, weighted_fit

# Budgets: how finely the fit ends decides nothing.
TURNS = 8
HALVINGS = 4
LEAST_GAIN = 1e-4  # of the misfit, beneath which a step is the last
TOUCH = 1e-3  # of a parameter, by which it is moved to see what the columns do
LEAST = 1e-9  # of its own unit


def refit_by_load(causes: Sequence[Cause], equations: Equations) -> None:
    """Gives causes whose columns follow the load the values and columns that explain most with all others;
    leaves them where no step explains more.
    """
    rows, own = equations.rows, equations.unknowns
    trials = [c.trial for c in causes]
    places = [k for k, t in enumerate(trials) if loaded(t, equations)]
    if not places:
        return
    theta = _bounded(weighted_fit(rows, with_causes(equations, trials)), trials, own)
    start = _anew(trials, places, theta, equations)
    if start is None:
        return
    table = with_causes(equations, start)
    least, best = misfit(rows, table, theta), trials
    trials = start
    for _ in range(TURNS):
        moved, slopes = linearised([trials[k] for k in places], trials, table, theta, equations)
        step = weighted_fit(moved, slopes) - theta
        for half in range(HALVINGS):
            tried = theta + step / 2**half
            anew = _anew(trials, places, tried, equations)
            there = None if anew is None else with_causes(equations, anew)
            value = np.inf if there is None else misfit(rows, there, tried)
            if value < least:
                break
        else:
            break
        assert anew is not None
        assert there is not None
        gained = least - value
        trials, table, theta, least = anew, there, tried, value
        best = trials
        if gained < LEAST_GAIN:
            break
    for cause, trial in zip(causes, best, strict=True):
        cause.trial = trial


def loaded(trial: FittedCandidate, equations: Equations) -> bool:
    """Whether a cause's columns follow the load, which is made by the arm's parameters."""
    return follows_load(trial.candidate, equations)


def follows_load(candidate: Candidate, equations: Equations) -> bool:
    """Whether columns of a candidate follow the load, as of `loaded`."""
    c = candidate
    return not (c.elastic or c.curved or unchanging(c, equations.evaluator))


def _values(trials: Sequence[FittedCandidate], theta: Array, own: int) -> list[Array]:
    """Values of each trial's columns, of theta (own unknowns, then these)."""
    ends = np.cumsum([own, *(t.columns[0].shape[2] for t in trials)])
    return [theta[begin:end] for begin, end in pairwise(ends)]


def _bounded(theta: Array, trials: Sequence[FittedCandidate], own: int) -> Array:
    """Unknowns and values to begin at: beside a load that something else carries in part, what may not be
    negative often is.
    """
    positive = [np.zeros(own, dtype=bool), *(np.array(t.candidate.positive, dtype=bool) for t in trials)]
    return np.asarray(np.where(np.concatenate(positive) & (theta < 0.0), 0.0, theta))


def _anew(
    trials: Sequence[FittedCandidate], places: Sequence[int], theta: Array, equations: Equations
) -> list[FittedCandidate] | None:
    """The trials, those at `places` with columns at theta; None where values leave their bounds, or the arm
    refuses them.
    """
    own, found = equations.unknowns, list(trials)
    base = equations.base(theta[:own])
    for k, values in enumerate(_values(trials, theta, own)):
        trial = trials[k]
        if (values[np.array(trial.candidate.positive, dtype=bool)] < 0.0).any():
            return None
        if k in places:
            columns = candidate_columns(trial.candidate, {**trial.values, **trial.around}, equations, base)
            if columns is None:
                return None
            trial = replace(trial, columns=columns)
        if not trial.candidate.elastic:
            trial = replace(trial, gain=replace(trial.gain, values=values))
        found[k] = trial
    return found


def linearised(
    following: Sequence[FittedCandidate],
    trials: Sequence[FittedCandidate],
    table: Sequence[Array],
    theta: Array,
    equations: Equations,
) -> tuple[list[Rows], list[Array]]:
    """Rows and columns by which a step of Gauss's and Newton's leads from theta (own unknowns, then values).

    following: those of the trials whose columns follow the load. table: (M, n, k), the model's own columns
    and the trials' of each record.
    """
    own = equations.unknowns
    values = [v for t, v in zip(trials, _values(trials, theta, own), strict=True) if _among(t, following)]
    change = load_slopes(following, values, theta[:own], equations)
    moved = [
        replace(r, effort=r.effort + d @ theta[:own]) for r, d in zip(equations.rows, change, strict=True)
    ]
    slopes = [
        np.concatenate([c[:, :, :own] + d, c[:, :, own:]], axis=2) for c, d in zip(table, change, strict=True)
    ]
    return moved, slopes


def _among(trial: FittedCandidate, others: Sequence[FittedCandidate]) -> bool:
    return any(trial is other for other in others)


def load_slopes(
    trials: Sequence[FittedCandidate], values: Sequence[Array], theta: Array, equations: Equations
) -> list[Array]:
    """What a change of each unknown does to the columns of loaded causes, times their values: (M, n, k).

    values: of each cause's columns. theta: (k,) unknowns. At the rows; what the filter does to it is left
    out.
    """
    found = [np.zeros((*r.effort.shape, len(theta))) for r in equations.rows]
    for trial, factors in zip(trials, values, strict=True):
        given = {**trial.values, **trial.around}
        here = columns_at_rows(trial.candidate, given, equations, equations.base(theta))
        for i, value in enumerate(theta):
            step = max(TOUCH * abs(float(value)), LEAST)
            base = equations.base(theta + step * (np.arange(len(theta)) == i))
            there = columns_at_rows(trial.candidate, given, equations, base)
            for table, a, b in zip(found, here, there, strict=True):
                table[:, :, i] += (b - a) @ factors / step
    return found
