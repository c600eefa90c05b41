"""The drives of an arm in numbers: motor and joint coordinates of whole records, drive gains."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import sympy as sp

from modelgen.description import Arm, geometry_symbol
from modelgen.effects import described
from modelgen.numeric import Array
from modelgen.transmission import Curves, Transmission, curves, of_joint


@dataclass(frozen=True)
class NumericDrive(Curves):
    """One coordinate's drive. driven: whether there is a motor at all. unit: of the motor coordinate.
    ratio: k1 where it is constant and q_m = k1 q, else None. of_length: motor coordinate per metre of the
    actuator's length, and at the length zero, None where it has none.
    """

    driven: bool
    unit: str
    ratio: float | None = None
    of_length: tuple[float, float] | None = None


_KEPT = 8  # arms whose drives are remembered: a stream asks for them block after block
_known: list[tuple[Arm, tuple[NumericDrive, ...]]] = []


def drives_of(arm: Arm) -> tuple[NumericDrive, ...]:
    """The drives of an arm's coordinates, in their order, as its effects on the description make them."""
    found = next((drives for known, drives in _known if known is arm), None)
    if found is None:
        changed = described(arm)
        joints = [changed.joints[i] for i in arm.coordinates]
        found = tuple(_drive(of_joint(changed, joint), joint.type == "prismatic") for joint in joints)
        _known.insert(0, (arm, found))
        del _known[_KEPT:]
    return found


def gains(arm: Arm, q: Array) -> Array:
    """Motor's speed over its joint's, (N, n), along positions q (N, n) of the coordinates."""
    return np.column_stack([drive.gain(x) for drive, x in zip(drives_of(arm), q.T, strict=True)])


@lru_cache(maxsize=64)
def _drive(t: Transmission, prismatic: bool) -> NumericDrive:
    known = {geometry_symbol(name): value for name, value in t.symbols.items()}
    return NumericDrive(
        **vars(curves(t)),
        driven=t.driven,
        unit=t.unit if t.driven else ("m" if prismatic else "rad"),
        ratio=_ratio(t.motor().subs(known), t.q),
        of_length=_of_length(t, known),
    )


def _of_length(t: Transmission, known: Mapping[sp.Symbol, float]) -> tuple[float, float] | None:
    found = t.drive.of_length()
    if found is None:
        return None
    per_length, at_zero = (float(sp.sympify(x).subs(known)) for x in found)
    return per_length, at_zero


def _ratio(motor: sp.Expr, q: sp.Symbol) -> float | None:
    """The factor of q where `motor` is just that."""
    factor = sp.sympify(motor).coeff(q)
    return float(factor) if factor.is_number and factor * q == motor else None
