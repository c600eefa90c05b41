"""Logs that were read wrongly: the same fit asks whether another reading explains the efforts far better."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from modelgen.dataset import Prepared, Record, drives_of, prepare
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.identification.validation import regression_of
from modelgen.numeric import Array

POOR = 0.15  # of the efforts of a joint, unexplained, from which on another reading is asked for
SOME = 0.05  # of them, that are unexplained at either joint of two that may be exchanged
BETTER = 0.33  # of what is unexplained, that another reading may leave to be believed
TURN = 2 * math.pi  # rad, or m
ROWS = 100  # per parameter, of a record that is asked


@dataclass(frozen=True)
class _Reading:
    record: Record
    question: str


def check_reading(train: Sequence[Prepared], model: Model, evaluator: Evaluator) -> None:
    """Ask about positions in degrees, motor angles named joint angles, and exchanged columns of two joints.

    Where the model explains little of the efforts of a joint, each such reading of the first record is fitted
    too, and believed where it leaves far less. Raises InputError with the question.
    """
    first = train[0].record
    if first.input is None or first.arm is None:
        return
    chosen = train[0].settings
    enough = 2 * chosen.trimmed(first.step) + ROWS * len(model.grouping.base) * chosen.factor
    record = first.part(0, min(len(first.t), enough))
    left = _unexplained(record, train[0], model, evaluator)
    if left is None:
        return
    if not (left > POOR).any():
        return
    total, found = float(np.sqrt(np.mean(left**2))), []
    for reading in _readings(record, left):
        other = _unexplained(reading.record, train[0], model, evaluator)
        if other is not None:
            found.append((float(np.sqrt(np.mean(other**2))), reading.question))
    best, question = min(found, default=(math.inf, ""))
    if best < min(BETTER * total, POOR):
        raise InputError(
            f"{first.name}: {question}? Then {100 * best:.2g} % of the efforts are left unexplained, as "
            f"the log stands {100 * total:.2g} %; a mapping file (--mapping) says what each column is"
        )


def _unexplained(record: Record, like: Prepared, model: Model, evaluator: Evaluator) -> Array | None:
    """RMS left of the efforts over theirs (n,), 0 for joints at rest; None where they cannot be read so."""
    try:
        prepared = prepare(record, like.settings)
        p = len(model.grouping.base)
        regression = regression_of(evaluator, model, [prepared], np.zeros(p))
        if sum(int(m.sum()) for m in regression.moving) < 3 * p:
            return None
        theta = regression.least_squares()
    except (InputError, np.linalg.LinAlgError, FloatingPointError):
        return None
    error, effort, moving = regression.residuals(theta)[0], regression.effort[0], regression.moving[0]
    shares = np.zeros(record.n)
    for j in range(record.n):
        rows = moving[:, j]
        if rows.any():
            size = max(float(np.linalg.norm(effort[rows, j])), 1e-300)
            shares[j] = float(np.linalg.norm(error[rows, j])) / size
    return shares


def _readings(record: Record, left: Array) -> Iterator[_Reading]:
    """Other readings of a record, each with its question. left: share of the efforts (n,) unexplained."""
    arm = record.arm
    assert arm is not None
    assert record.input is not None
    assert record.gain is not None
    joints = [arm.joints[i] for i in arm.coordinates]
    sides = record.motor_side or (False,) * record.n
    # Of small positions the model is linear in them, as a spring is: none but wide motions are asked.
    wide = [bool(np.ptp(record.q[:, k]) > TURN) and not sides[k] for k in range(record.n)]
    angles = [k for k, j in enumerate(joints) if j.type == "revolute" and wide[k]]
    if angles:
        q = record.q.copy()
        q[:, angles] *= math.pi / 180
        yield _Reading(replace(record, q=q), "are the positions in degrees")
    geared = [
        k
        for k, drive in enumerate(drives_of(arm))
        if wide[k] and drive.ratio is not None and abs(drive.ratio) > 1.0
    ]
    for some in [geared, *([k] for k in geared if len(geared) > 1)]:
        if some:
            q = record.q.copy()
            q[:, some] /= np.array([drives_of(arm)[k].ratio for k in some], dtype=float)
            names = ", ".join(f"q{k + 1}" for k in some)
            yield _Reading(replace(record, q=q), f"are the positions {names} those of the motors (qm<n>)")
    for a, b in combinations(range(record.n), 2):
        if max(left[a], left[b]) <= POOR or min(left[a], left[b]) <= SOME:
            continue
        both = f"joints {joints[a].name} and {joints[b].name}"
        order = list(range(record.n))
        order[a], order[b] = b, a
        logged = (record.input * record.gain)[:, order]
        yield _Reading(replace(record, input=logged / record.gain), f"are the efforts of {both} exchanged")
        if sides[a] == sides[b]:
            q, motor = record.q[:, order], record.motor[:, order]
            yield _Reading(replace(record, q=q, motor=motor), f"are the positions of {both} exchanged")
            swapped = replace(record, q=q, motor=motor, input=logged / record.gain)
            yield _Reading(swapped, f"are the columns of {both} exchanged")
