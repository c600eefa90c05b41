"""Drives, each written once as the motor coordinate q_m(q) in SymPy.

The generalised force at q_m is torque_constant i. Everything else follows from q_m(q): by
differentiation dq_m = k1 dq and ddq_m = k1 ddq + k2 with k1 = dq_m/dq and k2 = k1' dq^2, and by
virtual work the joint effort K i with K = torque_constant k1.
A new kind of drive is one more class in modelgen.linkages.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property, lru_cache
from typing import Any

import sympy as sp

from modelgen.description.objects import (
    Arm,
    DirectDrive,
    Joint,
    LeveredDrive,
    LinkageDrive,
    Range,
    Scalar,
    geometry_symbol,
)
from modelgen.linkages import LINKAGES


class Transmission(ABC):
    """One joint's drive: `q` and `q_m` are the symbols of the two coordinates."""

    q = sp.Symbol("q", real=True)
    q_m = sp.Symbol("q_m", real=True)

    def __init__(self, torque_constant: float) -> None:
        self.torque_constant = torque_constant
        self._kept: dict[str, sp.Expr] = {}

    driven = True
    unit = "unit"  # of the motor coordinate; a lever's may be anything, increments usually

    @abstractmethod
    def motor(self) -> sp.Expr:
        """q_m as a function of q."""

    @abstractmethod
    def joint(self) -> sp.Expr:
        """q as a function of q_m: the inverse of `motor` on the drive's range."""

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

    def _once(self, name: str, make: Callable[[], sp.Expr]) -> sp.Expr:
        """What symbolic differentiation gives, made when first asked for."""
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
        middle, k1 = self.middle(), self.k1()
        return self.q if middle is None or not k1.has(self.q) else self.motor() / k1.subs(self.q, middle)

    def inverse_gain(self) -> sp.Expr:
        """1/K [A per N m or N]."""
        return 1 / (self.torque_constant * self.k1())

    def joint_range(self) -> Range | None:
        """Range of q [rad] within which the drive works, None where it has no end."""
        return None

    def motor_range(self) -> Range | None:
        """The same in the motor coordinate."""
        return None


class Undriven(Transmission):
    """No drive: the input is the joint's effort, q_m = q."""

    driven = False

    def __init__(self) -> None:
        super().__init__(1.0)

    def motor(self) -> sp.Expr:
        """q_m = q."""
        return self.q

    def joint(self) -> sp.Expr:
        """q = q_m."""
        return self.q_m


class Direct(Transmission):
    """A geared motor, or a motor on a ball screw: q_m = ratio q."""

    unit = "rad"

    def __init__(self, drive: DirectDrive) -> None:
        super().__init__(drive.torque_constant)
        self.ratio = sp.sympify(drive.ratio)

    def motor(self) -> sp.Expr:
        """q_m = ratio q."""
        return self.ratio * self.q

    def joint(self) -> sp.Expr:
        """q = q_m / ratio."""
        return self.q_m / self.ratio


class Levered(Transmission):
    """A linear actuator on a lever: length q_p by the law of cosines, affine in q_m.

    Leborne, Creuze, Chemori and Brignone (2018); docs/theory.md says where the printed equations
    differ. With rev = +-1, q = rev q_j + offset and cos q_j = cos(q - offset).
    """

    def __init__(self, drive: LeveredDrive, values: dict[sp.Symbol, float]) -> None:
        super().__init__(drive.torque_constant)
        self.drive = drive
        self.values = values
        low, high = drive.length
        self.per_length = (drive.motor[1] - drive.motor[0]) / sp.sympify(high - low)  # motor unit per m
        self.low = sp.sympify(low)

    def _length(self) -> sp.Expr:
        """Cylinder length q_p [m] as a function of q."""
        l1, l2 = sp.sympify(self.drive.l1), sp.sympify(self.drive.l2)
        return sp.sqrt(l1**2 + l2**2 - 2 * l1 * l2 * sp.cos(self.q - self.drive.offset))

    def motor(self) -> sp.Expr:
        """q_m = m0 + (m1 - m0) (q_p - L0) / (L1 - L0)."""
        return self.drive.motor[0] + self.per_length * (self._length() - self.low)

    def _length_from_motor(self) -> sp.Expr:
        """Cylinder length q_p [m] as a function of q_m."""
        return self.low + (self.q_m - self.drive.motor[0]) / self.per_length

    def joint(self) -> sp.Expr:
        """q = rev arccos((l1^2 + l2^2 - q_p^2) / (2 l1 l2)) + offset."""
        l1, l2 = sp.sympify(self.drive.l1), sp.sympify(self.drive.l2)
        length = self._length_from_motor()
        return self.drive.rev * sp.acos((l1**2 + l2**2 - length**2) / (2 * l1 * l2)) + self.drive.offset

    def clearance(self) -> sp.Expr:
        """(q_p - L0) (L1 - q_p), widened by a thousandth of the stroke [m^2]: positive on the stroke."""
        low, high = (sp.sympify(end) for end in self.drive.length)
        length = self._length()
        return (length - low) * (high - length) + sp.Float(1e-3) * (high - low) ** 2

    def side(self) -> sp.Expr:
        """rev sin(q - offset): positive on the lever's own side of its dead centres."""
        return self.drive.rev * sp.sin(self.q - self.drive.offset)

    def triangle(self) -> sp.Expr:
        """Sixteen times the squared area of the lever's triangle over q_m [m^4]: positive where it exists."""
        l1, l2 = sp.sympify(self.drive.l1), sp.sympify(self.drive.l2)
        return 4 * l1**2 * l2**2 - (l1**2 + l2**2 - self._length_from_motor() ** 2) ** 2

    def inverse_gain(self) -> sp.Expr:
        """1/K = q_p / (torque_constant (m1 - m0)/(L1 - L0) l1 l2 sin(q - offset)): one division."""
        l1, l2 = sp.sympify(self.drive.l1), sp.sympify(self.drive.l2)
        scale = self.torque_constant * self.per_length * l1 * l2
        return self._length() / (scale * sp.sin(self.q - self.drive.offset))

    def joint_range(self) -> Range | None:
        """From the ends of the stroke."""
        return self._ends

    @cached_property
    def _ends(self) -> Range:
        ends = [float(self.joint().subs(self.q_m, m).subs(self.values)) for m in self.drive.motor]
        return min(ends), max(ends)

    def motor_range(self) -> Range | None:
        """The ends of the stroke themselves."""
        return min(self.drive.motor), max(self.drive.motor)


class Linked(Transmission):
    """A drive of modelgen.linkages."""

    def __init__(self, drive: LinkageDrive, values: dict[sp.Symbol, float]) -> None:
        super().__init__(drive.torque_constant)
        self.linkage = LINKAGES[drive.linkage]
        self.unit = self.linkage.unit
        self.figures = {name: sp.sympify(value) for name, value in drive.figures.items()}
        self.values = values

    def motor(self) -> sp.Expr:
        """q_m(q) of the linkage."""
        return self.linkage.motor(self.q, self.figures)

    def joint(self) -> sp.Expr:
        """Its inverse."""
        return self.linkage.inverse(self.q_m, self.figures)

    def joint_range(self) -> Range:
        """The reach of the linkage."""
        return self.linkage.reach({name: float(x.subs(self.values)) for name, x in self.figures.items()})

    def motor_range(self) -> Range:
        """The motor coordinates at its ends."""
        ends = [float(self.motor().subs(self.q, q).subs(self.values)) for q in self.joint_range()]
        return min(ends), max(ends)


STROKE_MARGIN = math.radians(0.05)  # [rad] beyond a lever's stroke before the status says so


def of_joint(arm: Arm, joint: Joint) -> Transmission:
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
    if isinstance(drive.value, DirectDrive):
        return Direct(drive.value)
    if isinstance(drive.value, LeveredDrive):
        return Levered(drive.value, {geometry_symbol(n): v for n, v in symbols.value})
    if isinstance(drive.value, LinkageDrive):
        return Linked(drive.value, {geometry_symbol(n): v for n, v in symbols.value})
    return Undriven()


def with_lever_symbols(arm: Arm) -> Arm:
    """The arm with lever geometry and joint offsets as named symbols, for use as run-time parameters.

    Symbols are called l1_2, l2_2, length0_2, length1_2, offset_2 and theta_2 for joint 2, and keep
    their present values; what is symbolic already stays.
    """
    symbols = dict(arm.symbols)

    def named(name: str, value: Scalar) -> Scalar:
        if isinstance(value, sp.Expr) or name in symbols:
            return value
        symbols[name] = value
        return geometry_symbol(name)

    def joint_with_symbols(number: int, joint: Joint) -> Joint:
        if joint.type == "revolute" and joint.moving and joint.theta != 0:
            joint = replace(joint, theta=named(f"theta_{number}", joint.theta))
        if not (isinstance(joint.drive, LeveredDrive) and joint.moving):
            return joint
        low, high = joint.drive.length
        drive = replace(
            joint.drive,
            l1=named(f"l1_{number}", joint.drive.l1),
            l2=named(f"l2_{number}", joint.drive.l2),
            length=(named(f"length0_{number}", low), named(f"length1_{number}", high)),
            offset=named(f"offset_{number}", joint.drive.offset),
        )
        return replace(joint, drive=drive)

    joints = tuple(joint_with_symbols(number, joint) for number, joint in enumerate(arm.joints, 1))
    return replace(arm, joints=joints, symbols=symbols)
