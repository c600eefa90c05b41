"""Gain, inertia and friction terms of any drive follow from q_m(q) by differentiation and virtual work.

dq_m = k1 dq and ddq_m = k1 ddq + k2 with k1 = dq_m/dq and k2 = k1' dq^2; the joint effort is K i with
K = torque_constant k1.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import cached_property, lru_cache
from typing import Any, Protocol

import sympy as sp

from modelgen.symbolic import Range, geometry_symbol
from modelgen.transmission.drive import Drive

STROKE_MARGIN = math.radians(0.05)  # [rad] beyond a drive's reach before the status says so


class Transmission:
    """One joint's drive: `q` and `q_m` are the symbols of the two coordinates.

    drive: with figures as expressions. symbols: values of the arm's named geometry.
    """

    q = sp.Symbol("q", real=True)
    q_m = sp.Symbol("q_m", real=True)

    def __init__(self, drive: Drive, symbols: Mapping[str, float]) -> None:
        self.drive = drive.symbolic()
        self.symbols = symbols
        self._described = drive
        self._kept: dict[str, sp.Expr] = {}

    @property
    def driven(self) -> bool:
        """Whether there is a motor."""
        return self.drive.driven

    @property
    def unit(self) -> str:
        """Unit of the motor coordinate."""
        return self.drive.unit

    @property
    def torque_constant(self) -> float:
        """Generalised force at the motor coordinate per input."""
        return self.drive.torque_constant

    def motor(self) -> sp.Expr:
        """q_m as a function of q."""
        return self.drive.motor_from_joint(self.q)

    def joint(self) -> sp.Expr:
        """q as a function of q_m."""
        return self.drive.joint_from_motor(self.q_m)

    def k1(self) -> sp.Expr:
        """dq_m/dq."""
        return self._once("k1", lambda: sp.diff(self.motor(), self.q))

    def slope(self) -> sp.Expr:
        """d^2 q_m/dq^2: k2 is this times dq^2."""
        return self._once("slope", lambda: sp.diff(self.motor(), self.q, 2))

    def inverse_rates(self) -> tuple[sp.Expr, sp.Expr]:
        """dq/dq_m and d^2 q/dq_m^2 as functions of q_m."""
        return (
            self._once("first", lambda: sp.diff(self.joint(), self.q_m)),
            self._once("second", lambda: sp.diff(self.joint(), self.q_m, 2)),
        )

    def inverse_gain(self) -> sp.Expr:
        """1/K [A per N m or N]."""
        return self._once("inverse_gain", lambda: self.drive.inverse_gain(self.q))

    @property
    def varies(self) -> bool:
        """Whether k1 depends on q."""
        return bool(self.k1().has(self.q))

    def _once(self, name: str, make: Callable[[], sp.Expr]) -> sp.Expr:
        """A result of symbolic differentiation, made when first asked for."""
        if name not in self._kept:
            self._kept[name] = make()
        return self._kept[name]

    def middle(self) -> sp.Expr | None:
        """q in the middle of the motor's range, None where it has no end."""
        ends = self.motor_range()
        return None if ends is None else self.joint().subs(self.q_m, sum(ends) / 2)

    def evened(self) -> sp.Expr:
        """q_m over k1 in the middle of the motor's range: q, up to a constant, where k1 is constant."""
        return self._once("evened", self._evened)

    def leverage(self) -> sp.Expr:
        """Its slope: k1 over that in the middle."""
        return self._once("leverage", lambda: sp.diff(self.evened(), self.q))

    def _evened(self) -> sp.Expr:
        middle = self.middle()
        return self.q if middle is None or not self.varies else self.motor() / self.k1().subs(self.q, middle)

    def joint_range(self) -> Range | None:
        """Range of q [rad, m] within which the drive works, None where it has no end."""
        return self._ranges[0]

    def motor_range(self) -> Range | None:
        """Range of the motor coordinate."""
        return self._ranges[1]

    @cached_property
    def _ranges(self) -> tuple[Range | None, Range | None]:
        """Ranges of joint and motor: where the description gives one, the other follows from q_m(q)."""
        known = {geometry_symbol(name): value for name, value in self.symbols.items()}
        stroke = self._described.stroke()
        if stroke is not None:
            ends = [float(self.joint().subs(self.q_m, x).subs(known)) for x in stroke]
            return (min(ends), max(ends)), stroke
        reach = self._described.numeric(self.symbols).reach()
        if reach is None:
            return None, None
        ends = [float(self.motor().subs(self.q, x).subs(known)) for x in reach]
        return reach, (min(ends), max(ends))


class Described(Protocol):
    """Anything with a drive: a joint of the description."""

    @property
    def drive(self) -> Drive:
        """Its drive."""


class Named(Protocol):
    """Anything with named geometry: an arm of the description."""

    @property
    def symbols(self) -> Mapping[str, float]:
        """Values by name."""


def of_joint(arm: Named, joint: Described) -> Transmission:
    """The transmission that a joint's drive describes; the same object for the same figures."""
    return _made(_Text(joint.drive), _Text(tuple(arm.symbols.items())))


class _Text:
    """A value told from others by its text: 1 and 1.0 are equal, and make other expressions."""

    def __init__(self, value: Any) -> None:
        self.value = value
        self.text = repr(value)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Text) and self.text == other.text

    def __hash__(self) -> int:
        return hash(self.text)


@lru_cache(maxsize=1024)
def _made(drive: _Text, symbols: _Text) -> Transmission:
    return Transmission(drive.value, dict(symbols.value))
