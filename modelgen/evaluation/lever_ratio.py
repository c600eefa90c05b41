"""A motion read at the motor, as a lever of other lengths would have made it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
import sympy as sp

from modelgen.description.objects import Arm, LeveredDrive, geometry_symbol
from modelgen.evaluation.motion import Motion
from modelgen.numeric import Array
from modelgen.transmission import Levered, Transmission, of_joint

Curve = Callable[[Array], Array]


@dataclass(frozen=True)
class _Curves:
    """Of a drive: q_m, dq_m/dq, d^2 q_m/dq^2 over q, and q over q_m."""

    motor: Curve
    k1: Curve
    slope: Curve
    joint: Curve


def reread(motion: Motion, before: Arm, after: Arm, joint: int) -> Motion:
    """The motion of coordinate number `joint` (from 1) through the drive of `after`, the motor's kept."""
    index, k = before.coordinates[joint - 1], joint - 1
    old, new = of_joint(before, before.joints[index]), of_joint(after, after.joints[index])
    q, dq, ddq = motion.q[:, k], motion.dq[:, k], motion.ddq[:, k]
    here, there = (
        _curves(old, tuple(before.symbols.items())),
        _curves(new, tuple(after.symbols.items())),
    )
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
    drive = of_joint(arm, arm.joints[arm.coordinates[joint - 1]])
    return np.asarray(float(drive.torque_constant) * _curves(drive, tuple(arm.symbols.items())).k1(q))


def leverage(arm: Arm, joint: int, q: Array) -> Array:
    """The ratio of the drive of coordinate number `joint` at its positions q (N,) over that in the middle."""
    drive = of_joint(arm, arm.joints[arm.coordinates[joint - 1]])
    middle, k1 = drive.middle(), _curves(drive, tuple(arm.symbols.items())).k1
    if middle is None:
        return np.ones(q.shape)
    known = {geometry_symbol(name): value for name, value in arm.symbols.items()}
    return np.asarray(k1(q) / k1(np.array([float(middle.subs(known))])))


@lru_cache(maxsize=256)
def _curves(drive: Transmission, symbols: tuple[tuple[str, float], ...]) -> _Curves:
    known = {geometry_symbol(name): value for name, value in symbols}
    if not isinstance(drive, Levered):
        return _bound(_compiled(drive, (), known), ())
    d = drive.drive
    figures = (d.l1, d.l2, *d.length, d.offset, *d.motor)
    values = tuple(float(x.subs(known)) if isinstance(x, sp.Expr) else float(x) for x in figures)
    return _bound(_lever(d.rev), values)


@lru_cache(maxsize=2)
def _lever(rev: int) -> tuple[Callable[..., Any], ...]:
    """The curves of any lever over its figures."""
    names = ("l1", "l2", "low", "high", "offset", "first", "last")
    l1, l2, low, high, offset, first, last = figures = [sp.Symbol(name, real=True) for name in names]
    motor: Any = (first, last)
    return _compiled(Levered(LeveredDrive(l1, l2, (low, high), motor, rev, offset, 1.0), {}), figures, {})


def _compiled(
    drive: Transmission, figures: Sequence[sp.Symbol], known: Mapping[sp.Symbol, float]
) -> tuple[Callable[..., Any], ...]:
    """motor, k1, slope, joint of a drive over its coordinate and these figures, with what is known."""
    curves = (
        (drive.q, drive.motor()),
        (drive.q, drive.k1()),
        (drive.q, drive.slope()),
        (drive.q_m, drive.joint()),
    )
    return tuple(sp.lambdify([x, *figures], sp.sympify(y).subs(known), "numpy", cse=True) for x, y in curves)


def _bound(calls: Sequence[Callable[..., Any]], values: Sequence[float]) -> _Curves:
    return _Curves(*(_curve(call, values) for call in calls))


def _curve(call: Callable[..., Any], values: Sequence[float]) -> Curve:
    def evaluate(x: Array) -> Array:
        with np.errstate(invalid="ignore"):
            return np.broadcast_to(np.asarray(call(x, *values), dtype=np.float64), x.shape)

    return evaluate
