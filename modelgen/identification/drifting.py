"""Efforts that drift over a record: the zero of their sensor moves, or friction warms up."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.dataset import Prepared, prepare
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.identification.beside import Added, Beside
from modelgen.identification.objects import DIAGNOSING, Doubt
from modelgen.numeric import Array

CLEARLY = 5.0  # standard deviations, which hold that residuals of neighbouring rows hang together
ROWS, PARTS = 300, 3  # per parameter, of a record that is asked, and parts in which they are spread over it
RECORDS = 4  # that are looked at, at most: each has columns of its own
NOTABLE = 0.01  # of the efforts' RMS, that a drift is over a record at least
SAID = "Parameters may be wrong by more than their deviations say."


def drifting(train: Sequence[Prepared], model: Model, evaluator: Evaluator) -> dict[int, Doubt]:
    """Questions by joint (from 0) whose efforts run away from the model's with time, in each record as fast
    as it may be; of many records some are looked at. None where a fit fails.
    """
    try:
        return _drifting(train, model, evaluator)
    except (InputError, np.linalg.LinAlgError, FloatingPointError):
        return {}  # what is wrong is said where the parameters are found


def _drifting(train: Sequence[Prepared], model: Model, evaluator: Evaluator) -> dict[int, Doubt]:
    """The same. Raises InputError, LinAlgError and FloatingPointError."""
    chosen = np.unique(np.linspace(0, len(train) - 1, RECORDS).astype(int))
    train = [train[k] for k in chosen]
    n, parts = train[0].n, [_spread(p, model) for p in train]
    found = Beside([part for own in parts for part in own], model, evaluator)
    if not found.enough:
        return {}
    shown = found.with_columns(_columns(train, parts))
    arm, said = train[0].record.arm, dict[int, Doubt]()
    assert arm is not None
    for j, name in enumerate(arm.coordinate_names):
        moved = [_drift(shown, found, k * n + j, j) for k in range(len(train))]
        notable = NOTABLE * found.logged[j]
        clear = [k for k, (size, std) in enumerate(moved) if abs(size) > max(CLEARLY * std, notable) > 0.0]
        if not clear:
            continue
        each = ", ".join(
            f"{moved[k][0]:.3g} ± {moved[k][1]:.1g} {train[k].record.effort_unit[j]} in "
            f"{np.ptp(train[k].time):.3g} s of {train[k].record.name}"
            for k in clear
        )
        text = (
            f"The efforts of {name} drift away from the model's, by {each}: does the zero of their sensor "
            f"drift, or does friction fall as it warms up{DIAGNOSING}? Log them at rest with the brake on "
            f"before and after, and let the arm warm up. {SAID}"
        )
        said[j] = Doubt(text, [name])
    return said


def _drift(shown: Added, found: Beside, column: int, j: int) -> tuple[float, float]:
    """Drift over a record and its deviation, in the log's unit; zero where it is not known."""
    return float(shown.amount[column] * found.gain[j]), float(shown.std[column] * found.gain[j])


def _spread(p: Prepared, model: Model) -> list[Prepared]:
    """Parts of a record that are enough to see a drift, from its beginning to its end; all of a short one."""
    around = 2 * p.settings.trimmed(p.record.step)
    size = around + -(-ROWS * len(model.grouping.base) * p.settings.factor // PARTS)
    last = len(p.record.t) - size
    if last < (PARTS - 1) * size:
        return [p]
    return [prepare(p.record.part(a, a + size), p.settings) for a in np.linspace(0, last, PARTS).astype(int)]


def _columns(train: Sequence[Prepared], parts: Sequence[Sequence[Prepared]]) -> list[Array]:
    """Columns (M, n, 2 records n) of each part: that run from -1/2 to 1/2 over one record at one joint each,
    and constants likewise, for a zero that drifts is none at the beginning rather than in the middle.
    """
    columns, n = [], train[0].n
    for k, (whole, own) in enumerate(zip(train, parts, strict=True)):
        for part in own:
            time = (part.time - whole.time[0]) / max(float(np.ptp(whole.time)), 1e-300) - 0.5
            added = np.zeros((len(part.rows), n, 2 * n * len(train)))
            for first, law in ((k * n, time), ((len(train) + k) * n, np.ones_like(time))):
                added[:, range(n), range(first, first + n)] = part.parallel(law[:, None] * part.weights)
            columns.append(added)
    return columns
