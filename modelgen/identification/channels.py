"""Faults of an effort's channel that parameters take up: a zero that is off, readings that fall short or are
smoothed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from modelgen.dataset import Prepared
from modelgen.dataset.processing.rounding import LONGEST, resolution
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator, Motion
from modelgen.functions import Model
from modelgen.identification.cut_off import LEVELS
from modelgen.identification.objects import DIAGNOSING, Doubt
from modelgen.identification.slow_turns import SAID as WRONG
from modelgen.identification.slow_turns import slow_turns
from modelgen.identification.validation import beginning, regression_of
from modelgen.numeric import Array
from modelgen.regression.least_squares import Regression, Solution

CLEARLY = 5.0  # standard deviations, which hold that residuals of neighbouring rows hang together
POWER = 5  # of the model's effort over its largest: what a channel lacks that is cut off, sharply or softly
COARSE = 2.0  # deviations of the effort, from which on its rounding is no noise beside it (Widrow 1956)
ZERO, SHORT = 0.1, 0.5  # of the squares that are left, which a constant and a curve explain at least
ABOVE_ALL = 0.5  # the same of a constant, in a diagnosis, which names effects


def effort_questions(
    train: Sequence[Prepared],
    model: Model,
    evaluator: Evaluator,
    zero: float = ZERO,
    *,
    short: bool = True,
) -> list[Doubt]:
    """Questions about joints of whose efforts a constant, or readings that fall short where they are large,
    explain a part that is no chance, or whose efforts are smoothed.

    Weights of links take up most of either, so that little shows in the residuals. zero: part of the squares
    that the model leaves, which a constant explains at least. short: whether efforts that fall short are
    asked about.
    """
    if any(p.record.input is None or p.record.arm is None for p in train):
        return []
    try:
        found = _Beside([beginning(p, model) for p in train], model, evaluator)
        if not found.enough:
            return []
        constants = found.explained(np.ones_like)
        curves = found.explained(lambda effort: effort**POWER) if short else None
        turns = slow_turns(found.records, found.own, model, evaluator)
    except (InputError, np.linalg.LinAlgError, FloatingPointError):
        return []  # what is wrong is said where the parameters are found
    first, said = train[0].record, list[Doubt]()
    assert first.arm is not None
    for j, name in enumerate(first.arm.coordinate_names):
        if _coarse(train, j):
            continue
        value, clear, share = (float(x[j]) for x in constants)
        if curves is not None and curves[1][j] < -CLEARLY and curves[2][j] > max(SHORT, share):
            text = (
                f"The efforts of {name} fall short of the model's where they are large, which explains "
                f"{100 * curves[2][j]:.0f} % of what it leaves: are they cut off, softly or beneath noise, "
                f"or does the motor saturate{DIAGNOSING}? {WRONG}"
            )
            said.append(Doubt(text, [name]))
        elif abs(clear) > CLEARLY and share > zero:
            value *= 1.0 if first.gain is None else float(np.sqrt(np.mean(first.gain[:, j] ** 2)))
            text = (
                f"A constant effort of {value:.3g} {first.effort_unit[j]} at {name} explains "
                f"{100 * share:.0f} % of what the model leaves there: are the readings zero without an "
                f"effort, and is friction the same either way{DIAGNOSING}? {WRONG}"
            )
            said.append(Doubt(text, [name]))
    return [*said, *turns]


def _coarse(train: Sequence[Prepared], j: int) -> bool:
    """Whether the effort of a coordinate has steps that are large beside its changes."""
    logged = [
        x[:LONGEST, j][p.awake[:LONGEST, j]] for p in train if (x := p.record.logged_effort) is not None
    ]
    moving = np.concatenate(logged)
    if not 0 < len(np.unique(moving)) < LEVELS:
        return len(moving) > 0 and (resolution(moving) or 0.0) > COARSE * float(np.std(moving))
    return True


class _Beside:
    """Records fitted by the model, and by a further column of each joint beside it."""

    def __init__(self, records: Sequence[Prepared], model: Model, evaluator: Evaluator) -> None:
        self.records, n, p = records, records[0].n, len(model.grouping.base)
        first = regression_of(evaluator, model, records, np.zeros(p))
        self.enough = sum(int(m.sum()) for m in first.moving) >= 3 * (p + n)
        theta = first.least_squares()
        own = regression_of(evaluator, model, records, theta)
        theta = own.least_squares()
        self.sigma = np.maximum(_sizes(own, theta), 1e-300)
        self.own, self.p = own, p
        motions = [Motion(r.time, r.q, r.dq, r.ddq, held=r.record.held) for r in records]
        self.efforts = [np.asarray(evaluator.regressor(model, m, theta) @ theta) for m in motions]
        self.largest = np.maximum(np.max([np.abs(x).max(axis=0) for x in self.efforts], axis=0), 1e-300)

    def explained(self, law: Callable[[Array], Array]) -> tuple[Array, Array, Array]:
        """The amount of a law of the model's effort over its largest, how many deviations that is, and the
        part of the squares that it explains, (n,) each; zeros where it cannot be known.
        """
        efforts, columns = [], []
        for k, r in enumerate(self.records):
            own = self.own.columns[k]
            added = r.parallel(law(self.efforts[k] / self.largest) * r.weights)
            more = np.zeros((len(added), r.n, r.n))
            more[:, range(r.n), range(r.n)] = added
            columns.append(np.concatenate([own, more], axis=2) / self.sigma[:, None])
            efforts.append(self.own.effort[k] / self.sigma)
        regression = Regression(efforts, columns, self.own.moving, self.own.white)
        solution: Solution = regression.solve("ols")
        amount = solution.theta[self.p :]
        std = np.sqrt(np.maximum(np.diag(solution.covariance)[self.p :], 0.0))
        known = solution.determined[self.p :] & (std > 0.0)
        clear = np.where(known, amount / np.where(std > 0.0, std, 1.0), 0.0)
        share = 1.0 - _sizes(regression, solution.theta) ** 2
        return np.where(known, amount, 0.0), clear, np.where(known, share, 0.0)


def _sizes(regression: Regression, theta: Array) -> Array:
    """RMS (n,) of what is left of the efforts over the rows that count."""
    left, moving = np.concatenate(regression.residuals(theta)), np.concatenate(regression.moving)
    return np.asarray(np.sqrt((left**2 * moving).sum(axis=0) / np.maximum(moving.sum(axis=0), 1)))
