"""What rounding of the efforts leaves alike in every period of a motion.

Efforts in coarse steps that do not differ from period to period by as much have the same errors in each:
what repeats of those is the mean of rounding over the noise that is there before (Widrow 1956).
"""

from __future__ import annotations

import numpy as np

from modelgen.dataset.processing.rounding import effort_steps, mean_error, scatter_of
from modelgen.diagnosis.equations.equations import Equations
from modelgen.diagnosis.equations.rows import Rows
from modelgen.evaluation import predicted
from modelgen.numeric import Array

SEED = 19560101  # of the place that a step has in the draw
HALVINGS = 40  # of what noise lies between


def left_by_rounded_efforts(r: Rows, period: int | None, equations: Equations, theta: Array) -> Array | None:
    """A draw of it in a record's rows (M, n); None where nothing repeats.

    period: rows in a period. theta: unknowns (k,) of a first fit. The model's own efforts are rounded at
    other places of the steps.
    """
    p, record = r.prepared, r.prepared.record
    logged = record.logged_effort
    if period is None or logged is None or p.input is None:
        return None
    steps, lag = effort_steps(record, 0.0), round(period * p.settings.stride)
    change = logged[lag:] - logged[:-lag]
    scatter = (change**2).mean(axis=0) / 2.0 if len(change) else np.zeros(record.n)
    noise = np.array([_noise(*x) for x in zip(steps, scatter, strict=True)])
    coarse = [k for k in range(record.n) if steps[k] > 0.0 and noise[k] < steps[k]]
    if not coarse:
        return None
    inputs = predicted(equations.evaluator, equations.model, r.motion, equations.base(theta))
    gain, random = np.ones_like(inputs) if p.gain is None else p.gain, np.random.default_rng(SEED)
    smooth, errors = p.smooth(inputs * gain), np.zeros_like(inputs)
    for k in coarse:
        values = smooth[:, k] + steps[k] * random.uniform()
        errors[:, k] = mean_error(values, float(steps[k]), float(noise[k])) / gain[:, k]
    return r.filtered(errors[:, :, None])[:, :, 0]


def _noise(step: float, scatter: float) -> float:
    """Deviation of noise before rounding to a step, beside which readings at one phase have so much variance
    over the periods.
    """
    low, high = 0.0, float(np.sqrt(scatter))
    for _ in range(HALVINGS if step > 0.0 else 0):
        middle = (low + high) / 2.0
        low, high = (low, middle) if scatter_of(step, middle) > scatter else (middle, high)
    return high
