"""Other readings of a log than the one that its columns and the mapping say."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from modelgen.dataset import Chosen, Prepared, Record, drives_of, prepare
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator, Motion, predicted
from modelgen.functions import Model
from modelgen.functions.nominal import known_base
from modelgen.identification.unexplained import POOR, Unexplained
from modelgen.identification.validation import regression_of

SOME = 0.05  # of the efforts, that are unexplained at either joint of two that may be exchanged
ROUNDS = 4  # of a fit and the signs that it gives to amounts
ZERO = 0.05  # of the 99 % quantile of amounts, below which the lowest of them is
TURN = 2 * math.pi  # rad, or m


@dataclass(frozen=True)
class Reading:
    """A record as it may be, and the question whether it is. faster: times (n,) that its speeds are those of
    the log as it stands; empty: they are alike.
    """

    record: Record
    question: str
    faster: tuple[float, ...] = ()

    def settings(self, chosen: Chosen) -> Chosen:
        """The settings of the log as it stands, with those of rest for these speeds."""
        if not self.faster:
            return chosen
        gates, noise = (
            tuple(x * times for x, times in zip(values, self.faster, strict=True))
            for values in (chosen.rest_speeds, chosen.noise)
        )
        return replace(chosen, rest_speeds=gates, noise=noise)


def readings(record: Record, fit: Unexplained) -> Iterator[Reading]:
    """Other readings of a record, each with its question. fit: of the record as it stands."""
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
        faster = np.ones(record.n)
        faster[angles] = math.pi / 180
        whose = "" if len(angles) == record.n else f" ({', '.join(f'q{k + 1}' for k in angles)})"
        degrees = replace(record, q=record.q * faster)
        yield Reading(degrees, f"are the positions in degrees{whose}", tuple(faster.tolist()))
    geared = [
        k
        for k, drive in enumerate(drives_of(arm))
        if wide[k] and drive.ratio is not None and abs(drive.ratio) > 1.0
    ]
    for some in [geared, *([k] for k in geared if len(geared) > 1)]:
        if some:
            slower = np.ones(record.n)
            slower[some] = [drives_of(arm)[k].ratio for k in some]
            names = ", ".join(f"q{k + 1}" for k in some)
            yield Reading(
                replace(record, q=record.q / slower),
                f"are the positions {names} those of the motors (qm<n>)",
                tuple((1.0 / np.abs(slower)).tolist()),
            )
    yield from _joint_angles(record)
    yield from _reversed(record)
    yield from _against_the_base(record)
    for a, b in combinations(range(record.n), 2):
        if max(fit.share[a], fit.share[b]) <= POOR or min(fit.share[a], fit.share[b]) <= SOME:
            continue
        both = f"joints {joints[a].name} and {joints[b].name}"
        order = list(range(record.n))
        order[a], order[b] = b, a
        logged = (record.input * record.gain)[:, order]
        yield Reading(replace(record, input=logged / record.gain), f"are the efforts of {both} exchanged")
        if sides[a] == sides[b]:
            q, motor = record.q[:, order], record.motor[:, order]
            yield Reading(replace(record, q=q, motor=motor), f"are the positions of {both} exchanged")
            swapped = replace(record, q=q, motor=motor, input=logged / record.gain)
            yield Reading(swapped, f"are the columns of {both} exchanged")


def _joint_angles(record: Record) -> Iterator[Reading]:
    """Angles of geared joints under the names of those of their motors."""
    assert record.arm is not None
    sides = record.motor_side or (False,) * record.n
    drives = drives_of(record.arm)
    some = [
        k
        for k, drive in enumerate(drives)
        if sides[k]
        and drive.ratio is not None
        and abs(drive.ratio) > 1.0
        and np.ptp(record.motor[:, k]) < TURN
    ]
    if not some:
        return
    q, motor = record.q.copy(), record.motor.copy()
    for k in some:
        q[:, k] = record.motor[:, k]
        motor[:, k] = q[:, k] * (drives[k].ratio or 1.0)
    names = ", ".join(f"qm{k + 1}" for k in some)
    logged = tuple(side and k not in some for k, side in enumerate(sides))
    yield Reading(
        replace(record, q=q, motor=motor, motor_side=logged),
        f"are the positions {names} those of the joints",
        tuple(abs(d.ratio or 1.0) if k in some else 1.0 for k, d in enumerate(drives)),
    )


def _reversed(record: Record) -> Iterator[Reading]:
    """Positions, and positions with their efforts, of a joint that are counted the other way."""
    assert record.arm is not None
    assert record.input is not None
    drives, names = drives_of(record.arm), record.arm.coordinate_names
    sides = record.motor_side or (False,) * record.n
    for k in range(record.n):
        q, motor, effort = record.q.copy(), record.motor.copy(), record.input.copy()
        if sides[k]:
            motor[:, k] = -motor[:, k]
            q[:, k] = drives[k].joint(motor[:, k])
        else:
            q[:, k] = -q[:, k]
            motor[:, k] = drives[k].motor(q[:, k])
        if not (np.isfinite(q).all() and np.isfinite(motor).all()):
            continue
        effort[:, k] = -effort[:, k]
        turned = replace(record, q=q, motor=motor)
        yield Reading(turned, f"are the positions of {names[k]} counted the other way")
        both = f"are positions and efforts of {names[k]} counted the other way"
        yield Reading(replace(turned, input=effort), both)


def _against_the_base(record: Record) -> Iterator[Reading]:
    """Angles that are not against the link before, but against what that is against."""
    assert record.arm is not None
    drives, names = drives_of(record.arm), record.arm.coordinate_names
    for k in range(1, record.n):
        q, motor = record.q.copy(), record.motor.copy()
        q[:, k] -= q[:, k - 1]
        motor[:, k] = drives[k].motor(q[:, k])
        if np.isfinite(motor[:, k]).all():
            whose = f"those of its link against the base, not against {names[k - 1]}"
            yield Reading(replace(record, q=q, motor=motor), f"are the positions of {names[k]} {whose}")


def amounts(
    record: Record, fit: Unexplained, like: Prepared, model: Model, evaluator: Evaluator
) -> Iterator[Reading]:
    """Efforts whose sign was lost, with that of the described model's efforts, fitted to them in turn."""
    assert record.arm is not None
    assert record.input is not None
    found = [
        int(j)
        for j in np.flatnonzero(fit.poor)
        if 0.0 <= record.input[:, j].min() < ZERO * float(np.quantile(record.input[:, j], 0.99))
    ]
    if not found:
        return
    whose = ", ".join(record.arm.coordinate_names[j] for j in found)
    try:
        prepared = prepare(record, like.settings)
        motion = Motion(prepared.time, prepared.q, prepared.dq, prepared.ddq)
    except InputError:
        return
    known = known_base(model)
    theta = np.array([known.get(b.name, 0.0) for b in model.grouping.base])
    for _ in range(ROUNDS):
        made = predicted(evaluator, model, motion, theta)
        given = record.input.copy()
        given[:, found] = np.where(made[:, found] < 0.0, -1.0, 1.0) * record.input[:, found]
        signed = replace(record, input=given)
        try:
            theta = regression_of(evaluator, model, [prepare(signed, like.settings)], theta).least_squares()
        except (InputError, np.linalg.LinAlgError, FloatingPointError):
            return
    yield Reading(signed, f"are the efforts of {whose} amounts without their sign")
