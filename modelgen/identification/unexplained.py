"""What a fit leaves of the efforts of a record, joint by joint, and whether that is much."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset import Prepared, Record, prepare
from modelgen.dataset.processing.content import white_noise
from modelgen.dataset.processing.periods import by_phase, folded
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.evaluation.link_encoder import compliant
from modelgen.functions import Model
from modelgen.identification.validation import regression_of, rows_in_period
from modelgen.numeric import Array
from modelgen.regression.least_squares import Regression

POOR = 0.15  # of the efforts of a joint, unexplained, from which on another reading is asked for
CHANGES = 0.25  # of their changes, likewise
FAR = 3.0  # times what noise is through the filter, that is none
ROUNDS = 30  # in which efforts are weighed by what is left of them
SETTLED = 0.01  # of that, by which it changes at the end
TURNS = 6  # in which the parameters of an arm with elastic joints settle
SMALLEST = 1e-5  # of an effort, that counts as left of it
LEAST = 1e-13  # of the largest eigenvalue, that a combination of parameters is found from


@dataclass(frozen=True)
class Unexplained:
    """share: RMS that least squares leave of the efforts over theirs (n,), 0 for joints at rest. error: what
    is left where the effort of each joint counts by that, changes: the deviation of the efforts from their
    mean, noise: that of white noise, repeats: of that error, what differs between periods of the motion, nan
    where none repeats; (n,) each, after the filter.
    """

    share: Array
    error: Array
    changes: Array
    noise: Array
    repeats: Array

    @property
    def poor(self) -> NDArray[np.bool_]:
        """Joints (n,) of which little is explained, of all or of the changes."""
        changes = self.error > CHANGES * np.maximum(self.changes, 1e-300)
        return (self.share > POOR) | (changes & (self.error > FAR * self.noise))


def unexplained(record: Record, like: Prepared, model: Model, evaluator: Evaluator) -> Unexplained | None:
    """What a fit leaves of the efforts of a record; None where they cannot be read so."""
    try:
        prepared = prepare(record, like.settings)
        p = len(model.grouping.base)
        regression = regression_of(evaluator, model, [prepared], np.zeros(p))
        if sum(int(m.sum()) for m in regression.moving) < 3 * p:
            return None
        plain, fair = regression.least_squares(), _by_what_is_left(regression)
        effort = regression.effort[0]
        for _ in range(TURNS if compliant(model.arm) else 0):  # elastic joints add what follows from these
            before = fair
            regression = regression_of(evaluator, model, [prepared], before)
            plain, fair = regression.least_squares(), _by_what_is_left(regression)
            if np.allclose(fair, before, rtol=SETTLED):
                break
    except (InputError, np.linalg.LinAlgError, FloatingPointError):
        return None
    moving = regression.moving[0]
    rate, cutoff = 1.0 / record.step, like.settings.cutoff
    shares = _size(regression.residuals(plain)[0], moving) / np.maximum(_size(effort, moving), 1e-300)
    residuals = regression.residuals(fair)[0]
    left = _size(residuals, moving)
    changes = np.array([np.std(x[m]) if m.any() else 0.0 for x, m in zip(effort.T, moving.T, strict=True)])
    assert record.input is not None
    band = min(1.0, 2.0 * cutoff / rate) if cutoff else 1.0
    noise = [math.sqrt(band) * white_noise(x, rate) for x in record.input.T]
    return Unexplained(shares, left, changes, np.array(noise), _between_periods(prepared, residuals, moving))


def _between_periods(p: Prepared, errors: Array, moving: NDArray[np.bool_]) -> Array:
    """RMS (n,) of what differs between periods of the errors (M, n) at rows that move (M, n)."""
    period, found = rows_in_period(p), np.full(errors.shape[1], np.nan)
    for j in range(len(found) if period is not None else 0):
        assert period is not None
        _, within, count = by_phase(folded(np.where(moving[:, j], errors[:, j], np.nan), period))
        free = int(np.maximum(count - 1, 0).sum())
        found[j] = math.sqrt(within.sum() / free) if free else np.nan
    return found


def _by_what_is_left(regression: Regression) -> Array:
    """Parameters (p,) by the efforts of each joint in proportion to what is left of them: where joints have
    units of their own, or one is read wrongly, the others keep what is theirs.
    """
    effort, table, moving = regression.effort[0], regression.columns[0], regression.moving[0]
    scale = np.linalg.norm(table.reshape(-1, table.shape[2]), axis=0)
    scale = np.where(scale > 0.0, scale, 1.0)
    rows = [(table[m, j] / scale, effort[m, j]) for j, m in enumerate(moving.T) if m.any()]
    grams, rights = np.array([x.T @ x for x, _ in rows]), np.array([x.T @ y for x, y in rows])
    squares, count = np.array([y @ y for _, y in rows]), np.array([len(y) for _, y in rows])
    left, theta = squares, np.zeros(len(scale))
    for _ in range(ROUNDS):
        weights = count / np.maximum(left, np.maximum(SMALLEST**2 * squares, 1e-300))
        values, vectors = np.linalg.eigh(np.einsum("j,jkl->kl", weights, grams))
        kept = values > LEAST * values.max(initial=0.0)
        theta = (vectors[:, kept] / values[kept]) @ (vectors[:, kept].T @ (weights @ rights))
        before, left = left, squares + np.einsum("k,jkl,l->j", theta, grams, theta) - 2.0 * rights @ theta
        if (np.abs(left - before) <= SETTLED * before).all():
            break
    return np.asarray(theta / scale)


def _size(values: Array, moving: NDArray[np.bool_]) -> Array:
    """RMS of values (M, n) over the rows that move (M, n), 0 for joints at rest: (n,)."""
    return np.array(
        [np.sqrt(np.mean(x[m] ** 2)) if m.any() else 0.0 for x, m in zip(values.T, moving.T, strict=True)]
    )
