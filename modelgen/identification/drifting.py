"""Efforts that drift over a record: the zero of a sensor moves, friction or a motor changes as it warms."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial.legendre import legvander
from scipy.stats import chi2, norm

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
ALIKE = 0.7  # of the clearest change's deviations, from which on another may as well be what changes
NOTABLE = 0.01  # of the efforts' RMS, that a drift is over a record at least
BENT = 5  # terms of a polynomial over a record, of what changes back and forth: two waves and a half
COURSE = 50  # points over a record, at which what bends is looked at
MOST = 37.0  # deviations: chances of more have no number
SAID = "Parameters may be wrong by more than their deviations say."


@dataclass(frozen=True)
class _Law:
    """A law of the joints' speeds and of the model's efforts, (N, n) each, that efforts may follow more or
    less as time goes by. what: of a joint's `name`; cause: what may do it; advice: what tells, or helps.
    relative: whether the change is said in % of the model's effort.
    """

    of: Callable[[Array, Array], Array]
    what: str
    cause: str
    advice: str
    relative: bool = False


_LAWS = (
    _Law(
        lambda speed, effort: np.ones_like(speed),
        "The efforts of {name} drift away from the model's",
        "does the zero of their sensor drift",
        "Log them at rest with the brake on before and after.",
    ),
    _Law(
        lambda speed, effort: np.sign(speed),
        "Friction at {name} changes",
        "does friction warm up, or the motion grow and the model lack a law of friction",
        "Let the arm warm up before it is logged.",
    ),
    _Law(
        lambda speed, effort: effort,
        "The efforts of {name} grow or shrink against the model's",
        "does the motor lose torque as it warms, the supply sag, or is a load picked up on the way",
        "Let the motor warm up before, log its temperature and supply, end a record where the load changes.",
        relative=True,
    ),
)


@dataclass(frozen=True)
class _Change:
    """Of the efforts of a joint by a law. clear: in its deviations, of the record in which it is clearest;
    each: of every record in which it is clear, in words.
    """

    law: _Law
    clear: float
    each: str


def drifting(
    train: Sequence[Prepared], model: Model, evaluator: Evaluator, terms: int = 1
) -> dict[int, Doubt]:
    """Questions by joint (from 0) whose efforts run away from the model's with time: alike whichever way the
    joint moves, against its motion, or in proportion, in each record as fast as it may be; of many records
    some are looked at. None where a fit fails. terms: of the polynomial over a record that is looked for, 1:
    a straight line.
    """
    try:
        return _drifting(train, model, evaluator, terms)
    except (InputError, np.linalg.LinAlgError, FloatingPointError):
        return {}  # what is wrong is said where the parameters are found


def _drifting(train: Sequence[Prepared], model: Model, evaluator: Evaluator, terms: int) -> dict[int, Doubt]:
    """The same. Raises InputError, LinAlgError and FloatingPointError."""
    chosen = np.unique(np.linspace(0, len(train) - 1, max(2, RECORDS // terms)).astype(int))
    train = [train[k] for k in chosen]
    n, parts = train[0].n, [_spread(p, model) for p in train]
    found = Beside([part for own in parts for part in own], model, evaluator)
    if not found.enough:
        return {}
    changes: list[list[_Change]] = [[] for _ in range(n)]
    size = np.maximum(found.logged / found.gain, 1e-300)
    for law in _LAWS:
        laws = [law.of(p.dq, effort / size) for p, effort in zip(found.records, found.efforts, strict=True)]
        shown = found.with_columns(_columns(train, parts, laws, terms))
        for j in range(n):
            firsts = range(0, len(train) * (terms + 1) * n, (terms + 1) * n)
            moved = [_over(shown, range(k + j, k + terms * n, n), found.gain[j]) for k in firsts]
            changes[j] += _clear(moved, law, float(found.logged[j]), train, j)
    arm = train[0].record.arm
    assert arm is not None
    return {
        j: Doubt(_question(name, own), [name])
        for j, (name, own) in enumerate(zip(arm.coordinate_names, changes, strict=True))
        if own
    }


def _over(shown: Added, places: Sequence[int], gain: float) -> tuple[float, float]:
    """Change over a record by the terms at these places, and its deviation, in the log's unit: of a line from
    the first to the last sample, of what bends from the least to the most, as clear as all terms together.
    """
    amount, known = shown.amount[places], shown.std[places] > 0.0
    if not known.all():
        return 0.0, 0.0
    if len(places) == 1:
        return float(amount[0] * gain), float(shown.std[places[0]] * gain)
    square = float(amount @ np.linalg.solve(shown.covariance[np.ix_(places, places)], amount))
    chance = float(chi2.sf(square, len(places)))
    course = 0.5 * legvander(np.linspace(-1.0, 1.0, COURSE), len(places))[:, 1:] @ amount
    change, clear = float(np.ptp(course) * gain), float(norm.isf(0.5 * chance)) if chance > 0.0 else MOST
    return change, change / max(clear, 1e-9)


def _clear(
    moved: Sequence[tuple[float, float]], law: _Law, size: float, train: Sequence[Prepared], j: int
) -> list[_Change]:
    """The change where it is clear. moved: over each record, and its deviation, in the log's unit; size: RMS
    of the efforts in that.
    """
    several = zip(moved, train, strict=True)
    clear = [(x, s, p) for (x, s), p in several if abs(x) > max(CLEARLY * s, NOTABLE * size) and s > 0.0]
    if not clear:
        return []
    unit, scale = ("%", 100.0 / size) if law.relative else ("", 1.0)
    each = (
        f"{scale * x:.3g} ± {scale * s:.1g} {unit or p.record.effort_unit[j]} in {np.ptp(p.time):.3g} s of "
        f"{p.record.name}"
        for x, s, p in clear
    )
    return [_Change(law, max(abs(x) / s for x, s, _ in clear), ", ".join(each))]


def _question(name: str, changes: Sequence[_Change]) -> str:
    """About the clearest change of a joint's efforts, and what else may be behind it."""
    best = max(changes, key=lambda change: change.clear)
    causes = [c.law.cause for c in changes if c is best or c.clear > ALIKE * best.clear]
    what = best.law.what.format(name=name)
    return f"{what}, by {best.each}: {', or '.join(causes)}{DIAGNOSING}? {best.law.advice} {SAID}"


def _spread(p: Prepared, model: Model) -> list[Prepared]:
    """Parts of a record that are enough to see a drift, from its beginning to its end; all of a short one."""
    around = 2 * p.settings.trimmed(p.record.step)
    size = around + -(-ROWS * len(model.grouping.base) * p.settings.factor // PARTS)
    last = len(p.record.t) - size
    if last < (PARTS - 1) * size:
        return [p]
    return [prepare(p.record.part(a, a + size), p.settings) for a in np.linspace(0, last, PARTS).astype(int)]


def _columns(
    train: Sequence[Prepared], parts: Sequence[Sequence[Prepared]], laws: Sequence[Array], terms: int
) -> list[Array]:
    """Columns (M, n, records (terms + 1) n) of each part, of one record and one joint each: its law (N, n)
    times polynomials that run from -1/2 to 1/2 or back to 1/2 over the record (Legendre), and the law by
    itself, for what drifts is not zero in the middle because it is at the beginning.
    """
    columns, n, left = list[Array](), train[0].n, iter(laws)
    for k, (whole, own) in enumerate(zip(train, parts, strict=True)):
        for part in own:
            law, over = next(left), (part.time - whole.time[0]) / max(float(np.ptp(whole.time)), 1e-300)
            bent = 0.5 * legvander(2.0 * over - 1.0, terms)[:, 1:]
            added = np.zeros((len(part.rows), n, len(train) * (terms + 1) * n))
            for i, time in enumerate([*bent.T, np.ones(len(over))]):
                first = (k * (terms + 1) + i) * n
                values = part.parallel(time[:, None] * law * part.weights)
                added[:, range(n), range(first, first + n)] = values
            columns.append(added)
    return columns
