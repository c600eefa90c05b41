"""A motion read at the motor, as a drive of other figures would have made it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from modelgen.description.objects import Arm
from modelgen.evaluation.motion import Motion
from modelgen.numeric import Array
from modelgen.symbolic import number
from modelgen.transmission import curves_over_figures, of_joint


def reread(motion: Motion, before: Arm, after: Arm, joint: int) -> Motion:
    """The motion of coordinate number `joint` (from 1) through the drive of `after`, the motor's kept."""
    index, k = before.coordinates[joint - 1], joint - 1
    here, there = (curves_over_figures(of_joint(arm, arm.joints[index])) for arm in (before, after))
    q, dq, ddq = motion.q[:, k], motion.dq[:, k], motion.ddq[:, k]
    k1 = here.k1(q)
    dmotor = k1 * dq
    ddmotor = k1 * ddq + here.slope(q) * dq**2
    moved = there.joint(here.motor(q))
    k1 = there.k1(moved)
    speed = dmotor / k1
    acceleration = (ddmotor - there.slope(moved) * speed**2) / k1
    tables = [motion.q.copy(), motion.dq.copy(), motion.ddq.copy()]
    for table, column in zip(tables, (moved, speed, acceleration), strict=True):
        table[:, k] = column
    return replace(motion, q=tables[0], dq=tables[1], ddq=tables[2])


def gain(arm: Arm, joint: int, q: Array) -> Array:
    """Joint effort per input of coordinate number `joint` (from 1) at its positions q (N,)."""
    return curves_over_figures(of_joint(arm, arm.joints[arm.coordinates[joint - 1]])).gain(q)


def leverage(arm: Arm, joint: int, q: Array) -> Array:
    """The ratio of the drive of coordinate number `joint` at its positions q (N,) over that in the middle."""
    drive = of_joint(arm, arm.joints[arm.coordinates[joint - 1]])
    middle, k1 = drive.middle(), curves_over_figures(drive).k1
    if middle is None:
        return np.ones(q.shape)
    return np.asarray(k1(q) / k1(np.array([number(middle, arm.symbols)])))
