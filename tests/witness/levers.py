"""A drive's motor coordinate from the points of its mechanism."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from modelgen.description import Arm, DirectDrive, LeveredDrive
from witness.geometry import number


class Drive:
    """One joint's drive; angles may be complex, for derivatives without cancellation."""

    def __init__(self, arm: Arm, joint: int) -> None:
        self.arm = arm
        self.drive = arm.joints[joint].drive
        self.constant = 1.0
        if isinstance(self.drive, DirectDrive | LeveredDrive):
            self.constant = self.drive.torque_constant
        if isinstance(self.drive, LeveredDrive):
            self.l1, self.l2 = number(arm, self.drive.l1), number(arm, self.drive.l2)
            self.low, self.high = (number(arm, x) for x in self.drive.length)
            self.offset = number(arm, self.drive.offset)
            self.per_metre = (self.drive.motor[1] - self.drive.motor[0]) / (self.high - self.low)

    def length(self, q: Any) -> Any:
        """Distance of the actuator's two pins: one on the axis of reference, one that turns."""
        assert isinstance(self.drive, LeveredDrive)
        inner = self.drive.rev * (q - self.offset)
        x, y = self.l2 * np.cos(inner) - self.l1, self.l2 * np.sin(inner)
        return np.sqrt(x * x + y * y)

    def motor(self, q: Any) -> Any:
        """q_m."""
        if isinstance(self.drive, DirectDrive):
            return number(self.arm, self.drive.ratio) * q
        if isinstance(self.drive, LeveredDrive):
            return self.drive.motor[0] + self.per_metre * (self.length(q) - self.low)
        return q

    def k1(self, q: Any) -> Any:
        """dq_m/dq: the moving pin's velocity along the actuator."""
        if isinstance(self.drive, DirectDrive):
            return number(self.arm, self.drive.ratio) + 0 * q
        if isinstance(self.drive, LeveredDrive):
            inner = self.drive.rev * (q - self.offset)
            pin = self.l2 * np.cos(inner), self.l2 * np.sin(inner)
            velocity = -self.drive.rev * pin[1], self.drive.rev * pin[0]
            along = velocity[0] * (pin[0] - self.l1) + velocity[1] * pin[1]
            return self.per_metre * along / self.length(q)
        return 1.0 + 0 * q

    def slope(self, q: Any) -> Any:
        """d^2 q_m/dq^2 by a complex step."""
        step = 1e-30
        return np.imag(self.k1(q + 1j * step)) / step

    def gain(self, q: Any) -> Any:
        """Joint effort per input."""
        return self.constant * self.k1(q)

    def span(self) -> tuple[float, float] | None:
        """Range of q over the stroke [rad], from the triangle's three sides."""
        if not isinstance(self.drive, LeveredDrive):
            return None
        ends = []
        for length in (self.low, self.high):
            # half angle from the semi-perimeter, not the law of cosines
            s = (self.l1 + self.l2 + length) / 2
            half = math.sqrt((s - self.l1) * (s - self.l2) / (self.l1 * self.l2))
            ends.append(self.drive.rev * 2 * math.asin(half) + self.offset)
        return min(ends), max(ends)
