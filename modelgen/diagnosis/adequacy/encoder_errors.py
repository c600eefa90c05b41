"""Errors of an encoder that repeat with each turn of its shaft, as those of an eccentric disc do.

A reading that is off by a sine of the shaft's angle is off in its speed and acceleration by far more, and the
model then has efforts that the arm has not, the larger the faster it goes: no law of a force, a spring or a
play does that, but several of them follow a part of it. What such an error does to all equations is found by
reading the same motion with it (Cook and Stefanski 1994).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from modelgen.dataset import Record, drives_of
from modelgen.diagnosis.adequacy.smooth_functions import SmoothFunction
from modelgen.diagnosis.equations import Equations, Rows, left_by_reading
from modelgen.diagnosis.evidence import System
from modelgen.numeric import Array

SIZE = 2e-3  # rad of the shaft, of an error by which the efforts still change in proportion


def of_encoder(j: int, system: System) -> Iterator[SmoothFunction]:
    """Errors of joint j's encoder (from 0) at its motor, where it is geared, and at a joint that turns.

    system: whose parameters say what the errors do to the efforts.
    """
    equations = system.equations
    drive = drives_of(equations.arm)[j]
    name = equations.arm.coordinate_names[j]
    theta = system.theta[: equations.columns[0].shape[2]]
    shafts = []
    if drive.ratio is not None and drive.unit in ("rad", "unit rad") and abs(drive.ratio) > 1.0:
        shafts.append((drive.ratio, f"turn of the motor at {name}"))
    if equations.arm.joints[equations.arm.coordinates[j]].type == "revolute":
        shafts.append((1.0, f"turn of {name}"))
    for ratio, turn in shafts:
        columns = [_columns(r, j, ratio, equations, theta) for r in equations.rows]
        text = f"an error of the encoder that repeats with each {turn}"
        yield SmoothFunction(text, {k: [x[:, k] for x in columns] for k in range(equations.n)}, encoder=j)


def _columns(r: Rows, j: int, ratio: float, equations: Equations, theta: Array) -> Array:
    """What a sine and a cosine of the shaft's angle, added to what joint j's encoder reads, leave in the
    residuals, (M, n, 2), by their size [rad of the shaft].
    """
    record = r.prepared.record
    errors = [SIZE * wave(ratio * record.q[:, j]) / ratio for wave in (np.sin, np.cos)]
    left = [left_by_reading(_read_with(record, j, error), r, equations, theta) for error in errors]
    return np.stack(left, axis=2) / SIZE


def _read_with(record: Record, j: int, error: Array) -> Record:
    """The record with an error (N,) [rad of the joint] of what joint j's encoder reads."""
    q, motor = record.q.copy(), record.motor.copy()
    q[:, j] += error
    if record.arm is not None:
        motor[:, j] = drives_of(record.arm)[j].motor(q[:, j])
    return replace(record, q=q, motor=motor)
