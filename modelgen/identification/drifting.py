"""Efforts that drift over a record: the zero of their sensor moves, or friction changes as it warms up."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.dataset import Prepared, prepare
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.identification.beside import Beside
from modelgen.identification.objects import DIAGNOSING, Doubt
from modelgen.numeric import Array

CLEARLY = 5.0  # standard deviations, which hold that residuals of neighbouring rows hang together
ROWS, PARTS = 300, 3  # per parameter, of a record that is asked, and parts in which they are spread over it
RECORDS = 4  # that are looked at, at most: each has columns of its own
NOTABLE = 0.01  # of the efforts' RMS, that a drift is over a record at least
SAID = "Parameters may be wrong by more than their deviations say."


_ZERO = (
    "The efforts of {name} drift away from the model's, by {each}: does the zero of their sensor drift"
    f"{DIAGNOSING}? Log them at rest with the brake on before and after. {SAID}"
)
_FRICTION = (
    "Friction at {name} changes, by {each}: does it warm up, or does the motion grow and the model lack a "
    f"law of friction{DIAGNOSING}? Let the arm warm up before it is logged. {SAID}"
)


def drifting(train: Sequence[Prepared], model: Model, evaluator: Evaluator) -> dict[int, Doubt]:
    """Questions by joint (from 0) whose efforts run away from the model's with time, the same whichever way
    the joint moves or against its motion, in each record as fast as it may be; of many records some are
    looked at. None where a fit fails.
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
        laws = []
        for law in range(2):
            columns = [(law * len(train) + k) * n + j for k in range(len(train))]
            moved = [(shown.amount[c] * found.gain[j], shown.std[c] * found.gain[j]) for c in columns]
            laws.append(_clear(moved, NOTABLE * found.logged[j], train, j))
        (zero, of_zero), (friction, of_friction) = laws
        if max(zero, friction) > 0.0:
            text, each = (_ZERO, of_zero) if zero >= friction else (_FRICTION, of_friction)
            said[j] = Doubt(text.format(name=name, each=each), [name])
    return said


def _clear(
    moved: Sequence[tuple[float, float]], notable: float, train: Sequence[Prepared], j: int
) -> tuple[float, str]:
    """The largest change over a record in its deviations, 0 where none is clear, and those that are in words.

    moved: change and deviation in each record, in the log's unit.
    """
    several = zip(moved, train, strict=True)
    clear = [(x, s, p) for (x, s), p in several if abs(x) > max(CLEARLY * s, notable) > 0.0 and s > 0.0]
    each = (
        f"{x:.3g} ± {s:.1g} {p.record.effort_unit[j]} in {np.ptp(p.time):.3g} s of {p.record.name}"
        for x, s, p in clear
    )
    return max((abs(x) / s for x, s, _ in clear), default=0.0), ", ".join(each)


def _spread(p: Prepared, model: Model) -> list[Prepared]:
    """Parts of a record that are enough to see a drift, from its beginning to its end; all of a short one."""
    around = 2 * p.settings.trimmed(p.record.step)
    size = around + -(-ROWS * len(model.grouping.base) * p.settings.factor // PARTS)
    last = len(p.record.t) - size
    if last < (PARTS - 1) * size:
        return [p]
    return [prepare(p.record.part(a, a + size), p.settings) for a in np.linspace(0, last, PARTS).astype(int)]


def _columns(train: Sequence[Prepared], parts: Sequence[Sequence[Prepared]]) -> list[Array]:
    """Columns (M, n, 4 records n) of each part, of one record and one joint each: time that runs from -1/2 to
    1/2, the same against the motion, and both without the time, for what drifts is not zero in the middle
    because it is at the beginning; the last not of the first record, whose friction is the model's.
    """
    columns, n = [], train[0].n
    for k, (whole, own) in enumerate(zip(train, parts, strict=True)):
        for part in own:
            time = (part.time - whole.time[0]) / max(float(np.ptp(whole.time)), 1e-300) - 0.5
            ones, sign = np.ones((len(time), n)), np.sign(part.dq)
            laws = (time[:, None] * ones, time[:, None] * sign, ones, sign if k else 0.0 * sign)
            added = np.zeros((len(part.rows), n, len(laws) * n * len(train)))
            for i, law in enumerate(laws):
                first = (i * len(train) + k) * n
                added[:, range(n), range(first, first + n)] = part.parallel(law * part.weights)
            columns.append(added)
    return columns
