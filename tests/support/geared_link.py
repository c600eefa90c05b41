"""A link on a geared motor with dry friction, about a level axis: its own equation, and none of modelgen's.

A test moves it along sines, and makes of its readings what the test is about.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

G = 9.81  # m/s^2
PERIOD = 8.0  # s, of the motion below
SIZE, W = np.array([0.5, 0.3, 0.15, 0.05]), 2 * np.pi * np.array([1, 2, 3, 5]) / PERIOD  # rad, rad/s


@dataclass(frozen=True)
class GearedLink:
    """mass [kg]. moment: of the mass [kg m]. inertia: about the joint's axis [kg m^2]. ratio: of the gear.
    constant: torque per current of the motor [N m/A]. viscous, dry, rotor: at the motor [N m s, N m, kg m^2].
    """

    mass: float
    moment: float
    inertia: float
    ratio: float
    constant: float
    viscous: float
    dry: float
    rotor: float = 0.0

    def currents(self, q: Array, dq: Array, ddq: Array) -> Array:
        """Currents (N,) [A] that a motion (N,) takes, whose angles [rad] count from the level."""
        motor = self.viscous * self.ratio * dq + self.dry * np.sign(dq) + self.rotor * self.ratio * ddq
        torque = self.inertia * ddq + G * self.moment * np.cos(q) + self.ratio * motor
        return np.asarray(torque / (self.ratio * self.constant))

    @property
    def parameters(self) -> dict[str, float]:
        """What is to be found, by the names that modelgen gives."""
        inertia = self.inertia + self.ratio**2 * self.rotor
        names = {"ZZ1R" if self.rotor else "ZZ1": inertia, "MX1": self.moment, "MY1": 0.0}
        return names | {"FV1": self.viscous, "FC1": self.dry}

    def description(self, *, values: bool = True) -> str:
        """The arm `one` in YAML. values: whether it says how large friction and rotor are."""
        effects = {
            "viscous_friction": ("coefficient", self.viscous),
            "coulomb_friction": ("magnitude", self.dry),
            "drive_inertia": ("inertia", self.rotor),
        }
        listed = ", ".join(
            f"{{{name}: {{{key}: {value:.9g}}}}}" if values else name
            for name, (key, value) in effects.items()
            if value
        )
        com = self.moment / self.mass
        own = f"{self.inertia - self.mass * com**2:.9g}"
        return f"""
schema: 1
convention: khalil_kleinfinger
arms:
  one:
    gravity: [0, -{G}, 0]
    joints:
      - {{name: hip, drive: {{type: direct, ratio: {self.ratio:.9g}, torque_constant: {self.constant:.9g}}},
         effects: [{listed}]}}
    links:
      hip: {{mass: {self.mass:.9g}, com: [{com:.9g}, 0, 0], inertia: [0.01, 0, 0, {own}, 0, {own}]}}
"""


LINK = GearedLink(mass=3.0, moment=0.6, inertia=0.22, ratio=40.0, constant=0.05, viscous=1.0e-3, dry=0.01)


def sines(t: Array, phase: Array, size: Array = SIZE, w: Array = W) -> tuple[Array, Array, Array]:
    """q, dq, ddq (N,) of a sum of sines at times t (N,) [s]; phase, size, w: (K,) [rad, rad, rad/s]."""
    q, dq, ddq = (
        (size * w**k * np.sin(t[:, None] * w + phase + k * np.pi / 2)).sum(axis=1) for k in range(3)
    )
    return q, dq, ddq
