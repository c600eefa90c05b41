"""A motion read at the motor, as a lever of other lengths would have made it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
import sympy as sp

from modelgen.description.objects import Arm, geometry_symbol
from modelgen.probing.motion import Array, Motion
from modelgen.transmission import Transmission, of_joint

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


@lru_cache(maxsize=256)
def _curves(drive: Transmission, symbols: tuple[tuple[str, float], ...]) -> _Curves:
    known = {geometry_symbol(name): value for name, value in symbols}
    return _Curves(
        _curve(drive.motor(), drive.q, known),
        _curve(drive.k1(), drive.q, known),
        _curve(drive.slope(), drive.q, known),
        _curve(drive.joint(), drive.q_m, known),
    )


def _curve(expression: sp.Expr, symbol: sp.Symbol, known: Mapping[sp.Symbol, float]) -> Curve:
    call = sp.lambdify(symbol, sp.sympify(expression).subs(known), "numpy", cse=True)

    def evaluate(x: Array) -> Array:
        with np.errstate(invalid="ignore"):
            return np.broadcast_to(np.asarray(call(x), dtype=np.float64), x.shape)

    return evaluate
