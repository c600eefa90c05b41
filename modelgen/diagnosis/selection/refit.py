"""Columns of causes at the values and the arm's parameters that are found with them.

Without a cause the arm's parameters take over what they can of it: a delay looks like damping that it takes
off, and what the cause is said to be worth at those parameters is too little by as much. Found anew in turns,
both come to where they belong.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from modelgen.diagnosis.candidates import (
    FittedCandidate,
    candidate_columns,
    named,
    prior_penalty,
    unchanging,
    with_causes,
)
from modelgen.diagnosis.equations import Equations
from modelgen.diagnosis.selection.cause import Cause
from modelgen.diagnosis.selection.refit_by_load import refit_by_load
from modelgen.numeric import Array
from modelgen.regression.weighted import misfit, weighted_fit

# When the turns end: how finely values are found decides nothing.
TURNS = 10
CLOSE = 0.005  # of a value, its change in a turn
NEAR = 0.05  # of a value, at which a column that follows no line stands for it
WORSE = 1e-4  # rise of the misfit by which a turn is not taken


def refit(causes: Sequence[Cause], equations: Equations) -> None:
    """Takes the columns of the causes anew until their values stay; an elastic joint's are as they were.

    What is left with a column that follows no line says little where it was made at another value than is
    found with it. Turns that go on over such count where they come to less.
    """
    trials, least = _turned(causes, equations, patient=False)
    if any(t.candidate.curved for t in trials):
        others, less = _turned(causes, equations, patient=True)
        trials = others if less < least else trials
    for cause, trial in zip(causes, trials, strict=True):
        cause.trial = trial
    refit_by_load(causes, equations)


def _turned(
    causes: Sequence[Cause], equations: Equations, *, patient: bool
) -> tuple[list[FittedCandidate], float]:
    """The causes after turns that leave less each, and the misfit that they end at. patient: whether turns go
    on from columns that follow no line and were not made near what was found, whatever these leave.
    """
    rows, own = equations.rows, equations.unknowns
    farthest = equations.thresholds.selection.max_refit_growth
    trials = [c.trial for c in causes]
    best, least, last, most = trials, np.inf, np.zeros(0), np.full(1, np.inf)
    at: list[Array] = [np.zeros(0)] * len(trials)  # values that columns were made at
    ways: list[Array] = [np.zeros(0)] * len(trials)  # by which they went there
    settled = True
    for turn in range(TURNS):
        table = with_causes(equations, trials)
        theta = weighted_fit(rows, table)
        left = misfit(rows, table, theta)
        if left > least + WORSE and settled:
            break
        ends = np.cumsum([own, *(t.columns[0].shape[2] for t in trials)])
        values = [theta[begin:end] for begin, end in pairwise(ends)]
        sizes = [
            sum(float(((c @ v) ** 2).sum()) for c in t.columns) for t, v in zip(trials, values, strict=True)
        ]
        if (np.array(sizes) > most).any():
            return [c.trial for c in causes], np.inf if patient else least
        best, least = trials, min(left, least) if settled else left
        settled = not patient or all(
            not t.candidate.curved or (len(a) == len(v) and np.allclose(v, a, rtol=NEAR))
            for t, a, v in zip(trials, at, values, strict=True)
        )
        if len(last) and np.allclose(theta[own:], last, rtol=CLOSE, atol=1e-12):
            break
        most = most if turn else farthest * np.array(sizes)
        base, last = equations.base(theta), theta[own:]
        for k, (trial, found) in enumerate(zip(best, values, strict=True)):
            at[k], ways[k] = (
                (found, np.zeros(0)) if not trial.candidate.curved else _towards(found, at[k], ways[k])
            )
        trials = [_anew(t, v, equations, base) for t, v in zip(best, at, strict=True)]
        if all(new is old for new, old in zip(trials, best, strict=True)):
            break
    return best, least


def _towards(found: Array, at: Array, way: Array) -> tuple[Array, Array]:
    """Values (k,) to make columns at, and the way there from those that they were made at.

    found: what was estimated with them. Where that lies back on the way that led there, half is gone: a law
    that bends much would swing from one side to the other for ever.
    """
    if not len(at):
        return found, found
    step = found - at
    if len(way):
        step = np.where(step * way < 0.0, step / 2, step)
    return at + step, step


def _anew(trial: FittedCandidate, values: Array, equations: Equations, base: Array) -> FittedCandidate:
    """Renew a trial's columns at values (k,) and base parameters; unchanged where the arm refuses them."""
    c = trial.candidate
    if c.elastic or unchanging(c, equations.evaluator) or (values[np.array(c.positive)] < 0).any():
        return trial
    after = replace(
        trial,
        gain=replace(trial.gain, values=values),
        prior_penalty=prior_penalty(c, named(c, values), equations.arm),
    )
    around = after.parameters if c.curved else {}
    found = candidate_columns(c, {**trial.values, **around}, equations, base)
    return trial if found is None else replace(after, columns=found, around=around)
