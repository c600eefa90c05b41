"""Joints without a drive, and those that a motor drives by a constant ratio."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import sympy as sp

from modelgen.symbolic import Scalar
from modelgen.transmission.drive import NO_LIMITS, Drive, MotorLimits
from modelgen.transmission.figures import Figure


@dataclass(frozen=True)
class NoDrive(Drive):
    """The joint's input is its effort: K = 1, q_m = q."""

    name = "none"
    text = "the input is the joint's effort"
    driven = False
    unit = "unit"
    title = "undriven"
    torque_constant = 1.0
    limits = NO_LIMITS

    def motor_from_joint(self, q: sp.Expr) -> sp.Expr:
        """q_m = q."""
        return q

    def joint_from_motor(self, q_m: sp.Expr) -> sp.Expr:
        """q = q_m."""
        return q_m


@dataclass(frozen=True)
class DirectDrive(Drive):
    """A geared motor, or a motor on a ball screw: q_m = ratio q. `torque_constant` in N m/A."""

    name = "direct"
    text = "a geared motor on the joint, q_m = ratio q; a ball-screw axis has ratio = 2 pi / lead [rad/m]"
    force_unit = "N m/A"

    ratio: Annotated[
        Scalar,
        Figure("plain", "Motor coordinate per joint coordinate [1; prismatic: rad/m].", must="nonzero"),
    ]
    torque_constant: float
    limits: MotorLimits = NO_LIMITS

    def motor_from_joint(self, q: sp.Expr) -> sp.Expr:
        """q_m = ratio q."""
        return self.ratio * q

    def joint_from_motor(self, q_m: sp.Expr) -> sp.Expr:
        """q = q_m / ratio."""
        return q_m / self.ratio

    @property
    def decides_motor(self) -> str:
        """Nothing: its range in q_m is that of the joint."""
        return ""


UNDRIVEN = NoDrive()
