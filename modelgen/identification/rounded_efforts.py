"""What the rounding of efforts does to parameters: coarse steps are no noise where efforts change slowly."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modelgen.dataset import Prepared
from modelgen.dataset.processing.rounding import effort_steps
from modelgen.evaluation import Evaluator, predicted
from modelgen.functions import Model
from modelgen.identification.effort_limits import gain_of, logged_of
from modelgen.identification.rows import motion_of
from modelgen.numeric import Array
from modelgen.regression.censored import Samples, censored
from modelgen.regression.least_squares import Regression, Solution

COARSE = 0.002  # of the efforts' RMS, that rounding is from which on it is looked at
DRAWS = 6  # of further roundings
ROUGH = 0.5  # of an effort's deviation, from which on its steps are no noise (Widrow 1961)
LEVELS = 4  # of an effort, with fewer of which nobody sees whether it is cut off
SIZES = 4  # rounds of a fit and the size of what it leaves
SAMPLES = 50_000  # that these fits look at


def with_rounding(
    solution: Solution, regression: Regression, train: Sequence[Prepared], model: Model, evaluator: Evaluator
) -> Solution:
    """The solution with what rounding of the efforts adds to its covariance.

    The model's own efforts, with the noise that the log has beside rounding, are rounded once more at other
    places of the steps, and fitted like the log's (Cook and Stefanski 1994). Noise of half a step or more
    makes rounding noise itself, and adds next to nothing.
    """
    steps = [effort_steps(p.record, COARSE) for p in train]
    if not any(x.any() for x in steps):
        return solution
    inputs, moves = [ideal(p, model, evaluator, solution.theta) for p in train], list[Array]()
    for seed in range(DRAWS):
        random = np.random.default_rng(seed)
        errors = [rounding(p, y, step, random) for p, y, step in zip(train, inputs, steps, strict=True)]
        moves.append(regression.moved_by(solution, errors) / np.sqrt(DRAWS))
    changed = _by_steps(train, model, evaluator, solution.theta, np.max(steps, axis=0))
    if changed is not None:
        moves.append(changed[solution.kept])
    return solution.uncertain_by(moves)


def _by_steps(
    train: Sequence[Prepared], model: Model, evaluator: Evaluator, theta: Array, steps: Array
) -> Array | None:
    """What parameters (p,) change where rough efforts are known to be within their steps, not as they stand.

    Both fits are to the same samples before the filter, so that their difference is that of the reading
    (Hausman 1978). None where no effort has steps (n,) that are large beside what it does.
    """
    every = max(1, sum(int(p.awake.sum()) for p in train) // SAMPLES)
    stepped, plain, rough = [], [], False
    for j in range(train[0].n):
        parts = []
        for p in train:
            full = np.asarray(evaluator.regressor(model, motion_of(p), theta))[:, j]
            at = np.flatnonzero(p.awake[:, j])[::every]
            parts.append((full[at] * gain_of(p)[at, j, None], logged_of(p)[at, j]))
        columns, effort = (np.concatenate(x) for x in zip(*parts, strict=True))
        plain.append(Samples(columns, effort, np.zeros(len(effort), dtype=np.intp)))
        large = bool(steps[j] > ROUGH * np.std(effort)) if len(effort) else False
        stepped.append(_within(plain[-1], float(steps[j])) if large else plain[-1])
        rough |= large
    if not rough:
        return None
    one, other = theta, theta
    for _ in range(SIZES):
        one, other = censored(stepped, one), censored(plain, other)
    return np.asarray(one - other)


def _within(x: Samples, step: float) -> Samples:
    """Readings that say within which step the truth was.

    Where there are so few that nobody sees whether they are cut off, the highest and the lowest of them say
    so much, or so little, at least.
    """
    side = np.ones(len(x.value), dtype=np.intp)
    width = np.full(len(x.value), step)
    value = x.value - step / 2.0
    levels = np.unique(x.value)
    if len(levels) < LEVELS:
        highest, lowest = x.value == levels[-1], x.value == levels[0]
        width[highest | lowest] = np.inf
        side[lowest] = -1
        value[lowest] += step
    return Samples(x.columns, value, side, width)


def ideal(p: Prepared, model: Model, evaluator: Evaluator, theta: Array) -> Array:
    """Inputs (N, n) of the model along a record."""
    return predicted(evaluator, model, replace(motion_of(p), held=False), theta)


def rounding(p: Prepared, inputs: Array, steps: Array, random: np.random.Generator) -> Array:
    """Errors (M, n) of the rows of a record, of another rounding of its inputs (N, n) to steps (n,)."""
    assert p.input is not None
    gain = np.ones_like(inputs) if p.gain is None else p.gain
    smooth, errors = p.smooth(inputs * gain), np.zeros_like(inputs)
    for k in np.flatnonzero(steps):
        step, logged = steps[k], smooth[:, k]
        # noise of the accelerations is in the one, jumps of friction are not in the other
        left = [(p.input[:, k] * gain[:, k] - y)[p.awake[:, k]] for y in (inputs[:, k] * gain[:, k], logged)]
        squares = min(float(np.mean(x**2)) for x in left) if len(left[0]) else 0.0
        noise = np.sqrt(max(squares - step**2 / 12.0, 0.0))
        place = step * random.uniform()
        noisy = logged + noise * random.normal(size=len(logged)) + place
        errors[:, k] = (step * np.rint(noisy / step) - noisy) / gain[:, k]
    return np.asarray(p.parallel(errors * p.weights))
