"""Arms as they are: links, drives, and the numbers of the laws in steps.c."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from blind.case import Array

ARM_NUMBERS = (
    "drag", "tip_x", "tip_y", "tip_z",  # N s^2/m^3; end of the last link in its frame [m]
    "spin",  # momentum of a wheel on the last link [kg m^2/s]
    "magnet", "tether", "anchor_x", "anchor_y", "anchor_z", "span",  # forces from a fixed point to the tip
)  # fmt: skip
JOINT_NUMBERS = (
    "scale", "length0",  # the motor turns by scale for each unit of its tendon beyond length0
    "kt", "lag", "limit", "grain", "filter", "kp", "kd", "ki", "forward",  # the loop, in motor angles
    "coulomb", "viscous", "bias", "skew", "skew_floor", "excess", "sped",
    "by_load", "load_floor", "worn", "middle", "wide",
    "cold_dry", "cold_viscous", "warm_time", "warm_speed",
    "bent", "bent_speed", "bent_form", "bristle", "distance", "elements",
    "order", "wave", "phase", "knee", "gain_wave", "gain_order",
    "spring", "rest", "stiffness", "damping", "gap",  # at the joint
    "strange", "strange_size", "a", "b", "c",
)  # fmt: skip
Push = Callable[[Array], Array]  # times (N) to efforts at a joint, or to factors of its torque constant (N)


@dataclass(frozen=True)
class Link:
    """A link and the joint that moves it, by modified Denavit-Hartenberg parameters, SI.

    inertia: tensor (3, 3) about the centre of mass, axes of the link's frame.
    """

    alpha: float
    d: float
    theta: float
    r: float
    slides: bool
    mass: float
    com: tuple[float, float, float]
    inertia: tuple[tuple[float, float, float], ...]


@dataclass(frozen=True)
class Lever:
    """A linear actuator between two points: l1 from the axis on the antecedent, l2 on the link [m].

    The angle between them is rev (q - angle). shortest, longest: its stroke [m].
    """

    l1: float
    l2: float
    rev: int
    angle: float
    shortest: float
    longest: float

    def length(self, q: Array) -> Array:
        """Length of the actuator [m] at joint angles: the distance of its two ends."""
        x = self.l1 - self.l2 * np.cos(q - self.angle)
        y = self.l2 * np.sin(q - self.angle)
        return np.hypot(x, y)

    def joint(self, length: Array) -> Array:
        """Joint angle [rad] at lengths of the actuator: half the angle by the triangle's semiperimeter."""
        s = (self.l1 + self.l2 + length) / 2
        tangent = (s - self.l1) * (s - self.l2) / (s * np.maximum(s - length, 1e-12))
        return self.angle + self.rev * 2 * np.arctan(np.sqrt(np.maximum(tangent, 0.0)))

    def arm(self, q: Array) -> Array:
        """Change of the length by the joint angle [m/rad]: how far the axis is from its line."""
        return self.l1 * self.l2 * np.sin(q - self.angle) / self.length(q)


@dataclass(frozen=True)
class Coupling:
    """A part that turns with a joint and `ratio` times another (numbers from 0): its own three numbers."""

    one: int
    other: int
    ratio: float
    inertia: float
    viscous: float
    dry: float


@dataclass(frozen=True)
class World:
    """An arm with its drives, as it is.

    rotors: inertia of each motor [kg m^2]; numbers: of steps.c, for each drive, and `space` of the arm.
    centre, reach, speed: of the motion, at the joints; scale: dry friction of each motor [N m], known or not.
    effects: what the user's description says of each joint.
    elastic: number of the joint (from 0) whose rotor moves on its own.
    payload: mass and place in the last link's frame, carried in one record.
    late: time by which the logged currents are older than said [s]; offset: true less read coordinates;
    eccentric: joint and size of a reading that waves with the place [rad].
    pushes, gains: disturbances over time, by joint (from 0).
    """

    links: tuple[Link, ...]
    levers: tuple[Lever | None, ...]
    rotors: tuple[float, ...]
    numbers: tuple[Mapping[str, float], ...]
    gravity: tuple[float, float, float]
    centre: Array
    reach: Array
    speed: Array
    scale: Array
    effects: tuple[tuple[str, ...], ...]
    space: Mapping[str, float] = field(default_factory=dict)
    elastic: int | None = None
    coupling: Coupling | None = None
    payload: tuple[float, float, float, float] | None = None
    late: float = 0.0
    offset: tuple[float, ...] = ()
    eccentric: tuple[int, float, float] | None = None
    pushes: Mapping[int, Push] = field(default_factory=dict)
    gains: Mapping[int, Push] = field(default_factory=dict)

    @property
    def count(self) -> int:
        """How many joints there are."""
        return len(self.links)

    def joint(self, k: int, **values: float) -> World:
        """The same with other numbers of joint k (from 0)."""
        own = list(self.numbers)
        own[k] = {**own[k], **values}
        return replace(self, numbers=tuple(own))

    def around(self, **values: float) -> World:
        """The same with other numbers of the arm."""
        return replace(self, space={**self.space, **values})

    def tendon(self, k: int, q: Array) -> Array:
        """Length of the tendon of joint k at joint coordinates: the coordinate, or the actuator's length."""
        lever = self.levers[k]
        return q if lever is None else lever.length(q)

    def motor(self, k: int, q: Array) -> Array:
        """Motor angle [rad] of joint k at joint coordinates."""
        own = self.numbers[k]
        turned: Array = own["scale"] * (self.tendon(k, q) - own["length0"])
        return turned

    def place(self, k: int, turned: Array) -> Array:
        """Joint coordinate at motor angles [rad]."""
        lever, own = self.levers[k], self.numbers[k]
        length = turned / own["scale"] + own["length0"]
        return length if lever is None else lever.joint(length)

    def gear(self, k: int, q: Array) -> Array:
        """Change of the motor angle by the joint coordinate; below zero where the lever works backwards."""
        lever = self.levers[k]
        one = np.ones_like(q) if lever is None else lever.arm(q)
        return one * self.numbers[k]["scale"]

    def middle_gear(self, k: int) -> float:
        """Size of `gear` in the middle of the motion."""
        return abs(float(self.gear(k, self.centre[k : k + 1])[0]))
