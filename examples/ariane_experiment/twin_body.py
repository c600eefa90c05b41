"""The arm of the experiment as a MuJoCo model, its levers and its numbers, all written down anew.

Imports nothing of modelgen: what is identified from its records is judged against it. Frames are modified
Denavit-Hartenberg (Khalil and Kleinfinger 1986), geometry and levers those of arms.yaml (Leborne, Creuze,
Chemori and Brignone 2018, Table II); inertials and frictions are this arm's own.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import mujoco

GRAVITY = 9.81  # m/s^2, along -z of the base


@dataclass(frozen=True)
class Lever:
    """A linear actuator on a lever: motor coordinate m [increments] to joint angle q [rad].

    l1, l2 [m]: from the joint's axis to the actuator's ends. shortest [m]: at m = 0; slope [m/increment].
    offset [rad]: q less the inner angle.
    """

    l1: float
    l2: float
    shortest: float
    slope: float
    offset: float

    def motor(self, q: float) -> float:
        """Motor coordinate of a joint angle, by the law of cosines."""
        return (self._length(q) - self.shortest) / self.slope

    def joint(self, m: float) -> float:
        """Joint angle of a motor coordinate."""
        length = self.shortest + self.slope * m
        cosine = (self.l1**2 + self.l2**2 - length**2) / (2 * self.l1 * self.l2)
        return math.acos(cosine) + self.offset

    def ratio(self, q: float) -> tuple[float, float]:
        """dm/dq and its derivative by q, from length^2 = l1^2 + l2^2 - 2 l1 l2 cos(inner angle)."""
        inner, length, product = q - self.offset, self._length(q), self.l1 * self.l2
        rate = product * math.sin(inner) / length
        return rate / self.slope, (product * math.cos(inner) - rate**2) / length / self.slope

    def _length(self, q: float) -> float:
        return math.sqrt(self.l1**2 + self.l2**2 - 2 * self.l1 * self.l2 * math.cos(q - self.offset))


@dataclass(frozen=True)
class Motor:
    """Of one drive, at the motor: torque constant [J/increment/A], inertia [J s^2/increment^2], viscous
    [J s/increment^2] and dry friction [J/increment].
    """

    constant: float
    inertia: float
    viscous: float
    dry: float


LEVERS = (
    Lever(0.323, 0.058, 0.267857, (0.368385 - 0.267857) / 20850, math.radians(-106.39)),
    Lever(0.073, 0.537, 0.484132, (0.584632 - 0.484132) / 6810, math.radians(-33.84)),
    Lever(0.489, 0.054, 0.437448, (0.536595 - 0.437448) / 26750, math.radians(93.65)),
)
MOTORS = (
    Motor(4.0e-3, 3.9e-8, 3.3e-7, 1.45e-3),
    Motor(1.2e-2, 2.8e-7, 5.9e-6, 5.2e-3),
    Motor(3.0e-3, 2.2e-8, 3.1e-7, 1.15e-3),
)
# By link, in its frame: mass [kg], centre of mass [m], inertia about it [kg m^2]: XX, XY, XZ, YY, YZ, ZZ.
LINKS = {
    "j1": (7.1, (0.045, 0.013, -0.035), (0.035, 0.0012, -0.0018, 0.044, 0.0007, 0.038)),
    "j2": (7.4, (0.23, 0.014, 0.017), (0.021, 0.0017, -0.0012, 0.127, 0.0006, 0.124)),
    "j3": (6.5, (-0.035, 0.19, 0.012), (0.101, 0.0026, 0.0006, 0.018, -0.0012, 0.105)),
    "j4": (2.6, (0.004, -0.003, 0.09), (0.012, 0.0001, -0.0002, 0.011, 0.0003, 0.005)),
}
_FRAMES = {
    "j1": (0.0, 0.0, 0.0),
    "j2": (math.pi / 2, 0.116, 0.0),
    "j3": (0.0, 0.443, 0.0),
    "j4": (-math.pi / 2, -0.1, 0.436),
}


def model(step: float) -> mujoco.MjModel:
    """Three hinges and the locked fourth link, integrated with `step` [s]; drives are added by the plant."""
    text = "<worldbody>"
    for name, (alpha, d, r) in _FRAMES.items():
        # Rot(x, alpha) Trans(x, d) Rot(z, q) Trans(z, r): the last two commute.
        place = f"{d} {-r * math.sin(alpha)} {r * math.cos(alpha)}"
        turn = f"{math.cos(alpha / 2)} {math.sin(alpha / 2)} 0 0"
        mass, com, (xx, xy, xz, yy, yz, zz) = LINKS[name]
        text += f'<body name="{name}" pos="{place}" quat="{turn}">'
        if name != "j4":
            # Dry friction acts as a constraint: a bound on its force, held exactly while the joint slides.
            text += f'<joint name="{name}" axis="0 0 1" frictionloss="1" '
            text += 'solreffriction="0.004 1" solimpfriction="0.9999 0.9999 0.001"/>'
        text += f'<inertial mass="{mass}" pos="{com[0]} {com[1]} {com[2]}" '
        text += f'fullinertia="{xx} {yy} {zz} {xy} {xz} {yz}"/>'
    text += "</body>" * len(_FRAMES) + "</worldbody>"
    option = f'<option timestep="{step}" gravity="0 0 {-GRAVITY}" integrator="Euler" tolerance="1e-10"/>'
    flags = '<compiler autolimits="false"/>'
    return mujoco.MjModel.from_xml_string(f"<mujoco>{flags}{option}{text}</mujoco>")
