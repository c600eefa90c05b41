"""Rows of records as a regression, and the prediction error on records that were not fitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from modelgen.dataset import Prepared
from modelgen.dataset.processing.filters import row_autocorrelation
from modelgen.dataset.processing.periods import noise_of, period_of, rows_in
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.identification.objects import Validation
from modelgen.identification.rows import Rows, motion_of
from modelgen.numeric import Array
from modelgen.regression.least_squares import Regression

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


def with_repeats(found: Validation, records: Sequence[Prepared]) -> Validation:
    """The validation with the noise of its records, where they repeat: what differs between their periods."""
    wrong = found.measured - found.predicted
    flags = np.ones_like(wrong, dtype=bool) if found.judged is None else found.judged
    ends, periods = np.cumsum([len(p.t) for p in records])[:-1], [rows_in_period(p) for p in records]
    parts = list(zip(np.split(wrong, ends), np.split(flags, ends), periods, strict=True))
    noise = []
    for j in range(wrong.shape[1]):
        own = [noise_of(e[:, j], m[:, j], rows) for e, m, rows in parts if rows is not None]
        squares = sum(float((values**2).sum()) for values, _ in own)
        count = sum(int(there.sum()) for _, there in own)
        noise.append(np.sqrt(squares / count) if count else np.nan)
    return replace(found, repeats=np.array(noise))


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
