"""The drives of an arm in numbers: motor and joint coordinates of whole records, drive gains."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import sympy as sp

from modelgen.description import Arm, geometry_symbol
from modelgen.numeric import Array
from modelgen.transmission import Transmission, of_joint

Curve = Callable[[Array], Array]


@dataclass(frozen=True)
class Drive:
    """One joint's drive as functions of arrays (N,).

    motor: q_m(q). joint: q(q_m). k1: dq_m/dq. slope: d^2 q_m/dq^2. torque_constant: generalised force at
    the motor coordinate per input. driven: whether there is a motor at all. ratio: k1 where it is constant
    and q_m = k1 q, else None.
    """

    motor: Curve
    joint: Curve
    k1: Curve
    slope: Curve
    torque_constant: float
    driven: bool
    unit: str
    ratio: float | None = None

    def gain(self, q: Array) -> Array:
        """K(q) (N,): joint effort per input."""
        return self.torque_constant * self.k1(q)


_KEPT = 8  # arms whose drives are remembered: a stream asks for them block after block
_known: list[tuple[Arm, tuple[Drive, ...]]] = []


def drives_of(arm: Arm) -> tuple[Drive, ...]:
    """The drives of an arm's coordinates, in their order."""
    found = next((drives for known, drives in _known if known is arm), None)
    if found is None:
        found = _made(arm)
        _known.insert(0, (arm, found))
        del _known[_KEPT:]
    return found


def _made(arm: Arm) -> tuple[Drive, ...]:
    symbols = tuple(arm.symbols.items())
    joints = [arm.joints[i] for i in arm.coordinates]
    return tuple(_drive(of_joint(arm, joint), symbols, joint.type == "prismatic") for joint in joints)


@lru_cache(maxsize=64)
def _drive(t: Transmission, given: tuple[tuple[str, float], ...], prismatic: bool) -> Drive:
    symbols = {geometry_symbol(name): value for name, value in given}

    def curve(expression: sp.Expr, symbol: sp.Symbol) -> Curve:
        call = sp.lambdify(symbol, sp.sympify(expression).subs(symbols), "numpy", cse=True)

        def evaluate(x: Array) -> Array:
            with np.errstate(invalid="ignore"):
                return np.broadcast_to(np.asarray(call(x), dtype=np.float64), np.shape(x)).copy()

        return evaluate

    return Drive(
        motor=curve(t.motor(), t.q),
        joint=curve(t.joint(), t.q_m),
        k1=curve(t.k1(), t.q),
        slope=curve(t.slope(), t.q),
        torque_constant=float(t.torque_constant),
        driven=t.driven,
        unit=t.unit if t.driven else ("m" if prismatic else "rad"),
        ratio=_ratio(t.motor().subs(symbols), t.q),
    )


def _ratio(motor: sp.Expr, q: sp.Symbol) -> float | None:
    """The factor of q where `motor` is just that."""
    factor = sp.sympify(motor).coeff(q)
    return float(factor) if factor.is_number and factor * q == motor else None
