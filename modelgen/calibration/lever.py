"""A lever in numbers: joint angle from motor coordinate, and its derivatives by the geometry.

Leborne, Creuze, Chemori and Brignone (2018), the law of cosines: q = rev q_j + offset,
cos q_j = (l1^2 + l2^2 - q_p^2) / (2 l1 l2), q_p affine in q_m.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.numeric import Array
from modelgen.symbolic import number

NAMES = ("l1", "l2", "qp_min", "qp_max", "offset")
UNITS = ("m", "m", "m", "m", "rad")
_DEAD = 0.995  # cosine beyond which `continued` follows its tangent: within 6 deg of a dead centre


@dataclass(frozen=True)
class Lever:
    """Branch, range of the motor coordinate, and (l1, l2, qp_min, qp_max [m], offset [rad])."""

    rev: int
    motor: tuple[float, float]
    values: Array

    def share(self, motor: Array) -> Array:
        """Position in the stroke (N,), 0 at qp_min and 1 at qp_max."""
        found: Array = (motor - self.motor[0]) / (self.motor[1] - self.motor[0])
        return found

    def cosine(self, motor: Array) -> Array:
        """cos q_j (N,) at motor coordinates (N,); beyond +-1 where the triangle does not close."""
        l1, l2, low, high = self.values[:4]
        length = low + (high - low) * self.share(motor)
        found: Array = (l1**2 + l2**2 - length**2) / (2 * l1 * l2)
        return found

    def angle(self, motor: Array) -> Array:
        """q (N,) [rad]; NaN where the triangle does not close."""
        with np.errstate(invalid="ignore"):
            found: Array = self.rev * np.arccos(self.cosine(motor)) + self.values[4]
        return found

    def continued(self, motor: Array) -> Array:
        """q (N,) [rad], continued smoothly to where the triangle does not close: for the search alone."""
        cosine = self.cosine(motor)
        inner = np.clip(cosine, -_DEAD, _DEAD)
        found: Array = np.arccos(inner) - (cosine - inner) / np.sqrt(1 - _DEAD**2)
        found = self.rev * found + self.values[4]
        return found

    def jacobian(self, motor: Array) -> Array:
        """Derivatives (N, 5) of `continued` by l1, l2, qp_min, qp_max and offset."""
        l1, l2, low, high = self.values[:4]
        share = self.share(motor)
        length = low + (high - low) * share
        cosine = self.cosine(motor)
        outer = -self.rev / np.sqrt(np.maximum(1 - cosine**2, 1 - _DEAD**2))
        by_l1 = 1 / l2 - cosine / l1
        by_l2 = 1 / l1 - cosine / l2
        by_length = -length / (l1 * l2)
        columns = [outer * by_l1, outer * by_l2, outer * by_length * (1 - share), outer * by_length * share]
        return np.column_stack([*columns, np.ones(len(motor))])


def lever_of(arm: Arm, joint: int) -> Lever:
    """The lever that the description gives coordinate `joint`, counted from 1.

    Raises InputError where there is none.
    """
    if not 1 <= joint <= len(arm.coordinates):
        raise InputError(f"--joint: found {joint}, expected 1 to {len(arm.coordinates)} ({arm.name})")
    own = arm.joints[arm.coordinates[joint - 1]]
    actuator = own.drive.actuator
    if actuator is None:
        levered = [arm.joints[i].name for i in arm.coordinates if arm.joints[i].drive.actuator]
        available = f"levered: {', '.join(levered)}" if levered else "the arm has no levered drive"
        raise InputError(f"--joint: joint {joint} ({own.name}) has no lever to calibrate ({available})")
    values = (actuator.l1, actuator.l2, *actuator.length, actuator.offset)
    return Lever(actuator.rev, actuator.motor, np.array([number(v, arm.symbols) for v in values]))
