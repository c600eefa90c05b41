"""Rows of records as a regression, and the prediction error on records that were not fitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline, interp1d

from modelgen.dataset import Prepared, prepare
from modelgen.dataset.processing.content import feigned_by_rounding
from modelgen.dataset.processing.filters import row_autocorrelation
from modelgen.dataset.processing.periods import period_of, rows_in
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.identification.objects import Identification, Validation
from modelgen.identification.rows import Rows, motion_of
from modelgen.numeric import Array
from modelgen.regression.least_squares import Regression

# Times the error of least squares. From noisy positions the biased values predict best by construction: the
# true ones err by this much more where noise has made a value this much squared too small (Fuller 1987, 1.1).
FAR_WORSE = 3.0
AROUND = 2.0  # samples, by which the period may be off that a record is said to have
ROWS = 100  # per parameter, of the beginning of a record that is asked about what it holds
LAGS = 13  # rows after which filtered noise hangs together no more


def validate(
    evaluator: Evaluator,
    model: Model,
    records: Sequence[Prepared],
    theta: Array,
    added: Sequence[Array] | None = None,
) -> Validation:
    """Prediction error on records that were not fitted. added: as for `regression_of`.

    Raises InputError for a free motion.
    """
    regression = regression_of(evaluator, model, records, theta, added, all_samples=True)
    gain = [np.ones(p.effort.shape) if p.gain is None else p.gain[p.rows] for p in records]
    more = [np.zeros_like(theta)] * len(records) if added is None else added
    parts = zip(records, regression.effort, regression.columns, more, strict=True)
    known = evaluator.known
    whole = [
        y + c @ m + (p.parallel(known.inputs(motion_of(p))) if known.any else 0.0) for p, y, c, m in parts
    ]
    measured = np.concatenate([y * g for y, g in zip(whole, gain, strict=True)])
    wrong = np.concatenate([e * g for e, g in zip(regression.residuals(theta), gain, strict=True)])
    moving = np.concatenate(regression.moving)
    if not moving.any():
        raise InputError(f"{records[0].record.name}: no joint moves in the test records; expected a motion")
    # A joint that rests throughout is judged by all its rows: holding is an effort too.
    asked = moving | ~moving.any(axis=0)
    rmse, share, judged = [], [], []
    for j in range(measured.shape[1]):
        rows = asked[:, j]
        e, y = wrong[rows, j], measured[rows, j]
        rmse.append(float(np.sqrt(np.mean(e**2))))
        judged.append(float(rows.sum()))
        share.append(100.0 * float(np.linalg.norm(e)) / max(float(np.linalg.norm(y)), 1e-300))
    t = np.concatenate([p.t for p in records])
    unit = records[0].effort_unit or ("",) * measured.shape[1]
    sizes = _sizes(regression, gain)
    return Validation(
        unit=unit,
        rmse=np.array(rmse),
        nrmse_percent=np.array(share),
        rows=np.array(judged),
        t=t,
        measured=measured,
        predicted=measured - wrong,
        sizes=sizes,
        judged=asked,
    )


def judged_by(found: Identification, test: Sequence[Prepared], evaluator: Evaluator | None) -> Identification:
    """The identification with what its test records say beside its errors: their noise, how coarse their
    positions are, and whether another estimate is far worse. evaluator: None where that is not asked.
    """
    if found.test is None:
        return found
    cutoff, limits = test[0].settings.cutoff, test[0].settings.thresholds
    coarse = [feigned_by_rounding(p.record, cutoff, limits)[0] for p in test] if cutoff else [0.0]
    found = replace(found, test=replace(with_repeats(found.test, test), coarse=max(coarse)))
    return found if evaluator is None else held_against(found, test, evaluator)


def with_repeats(found: Validation, records: Sequence[Prepared]) -> Validation:
    """The validation with the noise of its records, where they repeat: what differs between their periods."""
    wrong = found.measured - found.predicted
    flags = np.ones_like(wrong, dtype=bool) if found.judged is None else found.judged
    ends = np.cumsum([len(p.t) for p in records])[:-1]
    parts = list(zip(records, np.split(wrong, ends), np.split(flags, ends), strict=True))
    noise = []
    for j in range(wrong.shape[1]):
        own = [x for p, e, m in parts for x in _between_periods(p, e[:, j], m[:, j])]
        noise.append(np.sqrt(np.mean(np.concatenate(own) ** 2) / 2.0) if own else np.nan)
    return replace(found, repeats=np.array(noise))


def _between_periods(p: Prepared, errors: Array, judged: NDArray[np.bool_]) -> list[Array]:
    """Differences of the errors (M,) from those a period later, where both are judged; none where nothing
    repeats.

    A period need be no whole number of rows, nor known better than to a few samples.
    """
    period = period_of(p.record, None)
    if period is None:
        return []
    later, there = CubicSpline(p.t, errors), interp1d(p.t, judged.astype(float), bounds_error=False)
    found = list[Array]()
    for shift in period + np.arange(-AROUND, AROUND + 0.25, 0.5):
        at = p.t + shift * p.record.step
        both = judged & (np.nan_to_num(there(at)) == 1.0)
        if both.any():
            found.append(later(at[both]) - errors[both])
    return [min(found, key=lambda x: float(np.mean(x**2)))] if found else []


def held_against(found: Identification, test: Sequence[Prepared], evaluator: Evaluator) -> Identification:
    """The identification; its estimate by instruments is weak where it predicts test records far worse than
    the bias that it claims can explain.
    """
    both, own = found.comparison, found.test
    if both is None or own is None or not both.biased or found.method == "iv":
        return found
    other = validate(evaluator, found.model, test, both.solution.theta)
    weak = bool((other.rmse > FAR_WORSE * own.rmse).any())
    return replace(found, comparison=replace(both, weak=weak))


def beginning(p: Prepared, model: Model) -> Prepared:
    """The part of a record that is enough to ask what it holds."""
    enough = 2 * p.settings.trimmed(p.record.step) + ROWS * len(model.grouping.base) * p.settings.factor
    return p if enough >= len(p.record.t) else prepare(p.record.part(0, enough), p.settings)


def rows_in_period(p: Prepared) -> int | None:
    """Rows in a period of the motion; None where it does not repeat, or not on whole rows."""
    return rows_in(period_of(p.record, None), p.settings)


def _sizes(regression: Regression, gain: Sequence[Array]) -> Array:
    """RMS of every column in the unit of the log's efforts, (n, p), over the rows that move."""
    moved = [m[:, :, None] for m in regression.moving]
    squares = sum(
        ((c * g[:, :, None] * m) ** 2).sum(axis=0)
        for c, g, m in zip(regression.columns, gain, moved, strict=True)
    )
    rows = sum(m.sum(axis=0) for m in moved)
    return np.asarray(np.sqrt(squares / np.maximum(rows, 1)))


def regression_of(
    evaluator: Evaluator,
    model: Model,
    records: Sequence[Prepared],
    theta: Array,
    added: Sequence[Array] | None = None,
    *,
    all_samples: bool = False,
) -> Regression:
    """Rows of the records. theta: for columns that depend on the load [base]. all_samples: as for `Rows`.

    added: base parameters (p,) that each record has in addition, of a payload: what they take is subtracted
    the effort.
    """
    made = Rows(model, evaluator, all_samples=all_samples)
    effort, columns = [], []
    for k, p in enumerate(records):
        more = np.zeros_like(theta) if added is None else added[k]
        y, w = made.of(p, theta + more)
        whole = made.whole(w)
        effort.append(y - whole @ more if more.any() else y)
        columns.append(whole)
    chosen, rate = records[0].settings, 1.0 / records[0].record.step
    white = None
    if chosen.cutoff:
        white = row_autocorrelation(chosen.cutoff, rate, chosen.order, chosen.stride, LAGS)
    return Regression(effort, columns, [made.moving(p) for p in records], white)
