"""A motion read at the motor, as a lever of other lengths would have made it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import sympy as sp

from modelgen.description.objects import Arm, geometry_symbol
from modelgen.probing.motion import Array, Motion
from modelgen.transmission import of_joint

Curve = Callable[[Array], Array]


def reread(motion: Motion, before: Arm, after: Arm, joint: int) -> Motion:
    """The motion of coordinate number `joint` (from 1) through the drive of `after`, the motor's kept."""
    index, k = before.coordinates[joint - 1], joint - 1
    old, new = of_joint(before, before.joints[index]), of_joint(after, after.joints[index])
    q, dq, ddq = motion.q[:, k], motion.dq[:, k], motion.ddq[:, k]
    motor = _curve(before, old.motor(), old.q)(q)
    k1 = _curve(before, old.k1(), old.q)(q)
    dmotor = k1 * dq
    ddmotor = k1 * ddq + _curve(before, old.slope(), old.q)(q) * dq**2
    moved = _curve(after, new.joint(), new.q_m)(motor)
    k1 = _curve(after, new.k1(), new.q)(moved)
    speed = dmotor / k1
    acceleration = (ddmotor - _curve(after, new.slope(), new.q)(moved) * speed**2) / k1
    tables = [motion.q.copy(), motion.dq.copy(), motion.ddq.copy()]
    for table, column in zip(tables, (moved, speed, acceleration), strict=True):
        table[:, k] = column
    return replace(motion, q=tables[0], dq=tables[1], ddq=tables[2])


def _curve(arm: Arm, expression: sp.Expr, symbol: sp.Symbol) -> Curve:
    known = {geometry_symbol(name): value for name, value in arm.symbols.items()}
    call = sp.lambdify(symbol, sp.sympify(expression).subs(known), "numpy", cse=True)

    def evaluate(x: Array) -> Array:
        with np.errstate(invalid="ignore"):
            return np.broadcast_to(np.asarray(call(x), dtype=np.float64), x.shape)

    return evaluate
