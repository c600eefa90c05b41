"""Arms drawn by seed: links, drives, loops, and what of them the user knows."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from blind.case import Array
from blind.family_b.equations import lumped, motor, still

GRAVITY = 9.81
SHAPES = ("planar", "spatial", "planar_levered", "spatial_levered")
Push = Callable[[Array], Array]  # times (N) to joint efforts (N, 3), or to factors (N)


@dataclass(frozen=True)
class Body:
    """A link: mass [kg], centre of mass in its plane [m], moments of inertia about it (x, y, z) [kg m^2]."""

    mass: float
    x: float
    y: float
    along: float
    across: float
    turn: float


@dataclass(frozen=True)
class World:
    """An arm with its drives, as it is.

    arm, joints: numbers of plant.c; axes: which of its axes are joints 1, 2, ...; bodies: its links.
    centre, reach, speed: of the motion, at the joints [rad, rad/s]; scale: dry friction at the motor [N m].
    effects: what the user's description says of each joint.
    late: time by which the logged current is older than said [s]; offset: true less read angles [rad];
    payload: mass, x and y on the fore link, in the records of `carried` alone.
    push, gain: disturbances and factors of the torque constants, over time.
    """

    arm: dict[str, float]
    joints: tuple[dict[str, float], ...]
    axes: tuple[int, ...]
    bodies: tuple[Body, ...]
    centre: Array
    reach: Array
    speed: Array
    scale: Array
    effects: tuple[tuple[str, ...], ...]
    late: float = 0.0
    offset: tuple[float, float, float] = (0.0, 0.0, 0.0)
    payload: tuple[float, float, float] | None = None
    push: Push | None = None
    gain: Push | None = None

    def joint(self, number: int, **values: float) -> World:
        """The same with other numbers of joint `number`, which counts from 1."""
        changed = list(self.joints)
        changed[self.axes[number - 1]] = {**changed[self.axes[number - 1]], **values}
        return replace(self, joints=tuple(changed))

    def whole(self, **values: float) -> World:
        """The same with other numbers of the arm."""
        return replace(self, arm={**self.arm, **values})

    def of(self, number: int) -> dict[str, float]:
        """Numbers of joint `number`, which counts from 1."""
        return self.joints[self.axes[number - 1]]


def rounded(x: float, digits: int = 4) -> float:
    """A number as it stands in a description."""
    return float(f"{x:.{digits}g}")


def draw(rng: np.random.Generator, shape: str) -> World:
    """Arm of a shape."""
    planar, levered = shape.startswith("planar"), shape.endswith("levered")
    upper, fore = rounded(rng.uniform(0.3, 0.55), 3), rounded(rng.uniform(0.25, 0.45), 3)
    bodies = (
        Body(rounded(rng.uniform(3, 10)), 0.0, 0.0, *[rounded(rng.uniform(0.02, 0.08))] * 3),
        _link(rng, rng.uniform(3, 9), upper),
        _link(rng, rng.uniform(1.5, 5), fore),
    )
    arm = {
        **lumped(bodies[1], "2"),
        **lumped(bodies[2], "3"),
        "column": bodies[0].turn,
        "offset": 0.0 if planar else rounded(rng.uniform(0.0, 0.12), 3),
        "length": upper,
        "reach3": fore,
        "gz": -GRAVITY,
        "locked": float(planar),
    }
    if rng.random() < 0.25:  # mounted aslant, and described so
        slant = rng.uniform(-0.6, 0.6)
        arm["gx"], arm["gz"] = rounded(-GRAVITY * math.sin(slant)), rounded(-GRAVITY * math.cos(slant))
    centre = np.array([0.0, rng.uniform(-0.3, 0.6), rng.uniform(-0.9, 0.9)])
    reach = np.array([rng.uniform(0.7, 1.3), rng.uniform(0.5, 0.9), rng.uniform(0.6, 1.0)])
    speed = rng.uniform(0.8, 1.6, 3)
    levers = (False, levered and rng.random() < 0.5, levered)
    drives = [_drive(rng, arm, axis, centre, reach, speed, levers[axis]) for axis in range(3)]
    axes = (1, 2) if planar else (0, 1, 2)
    return World(
        arm=arm,
        joints=tuple(d for d, _ in drives),
        axes=axes,
        bodies=bodies,
        centre=centre,
        reach=reach,
        speed=speed,
        scale=np.array([s for _, s in drives]),
        effects=(("viscous_friction", "coulomb_friction", "drive_inertia"),) * len(axes),
    )


def _link(rng: np.random.Generator, mass: float, length: float) -> Body:
    across = mass * length**2 / 12 * rng.uniform(0.8, 1.6)
    return Body(
        rounded(mass),
        rounded(length * rng.uniform(0.3, 0.6), 3),
        rounded(rng.uniform(-0.03, 0.03), 2),
        rounded(across * rng.uniform(0.05, 0.15), 3),
        rounded(across, 3),
        rounded(across * rng.uniform(0.97, 1.03), 3),
    )


def _drive(
    rng: np.random.Generator,
    arm: dict[str, float],
    axis: int,
    centre: Array,
    reach: Array,
    speed: Array,
    levered: bool,
) -> tuple[dict[str, float], float]:
    """Numbers of a joint's drive and loops, and the scale of its friction at the motor."""
    inertia, weight = still(arm, centre, reach)
    effort = 1.2 * weight[axis] + inertia[axis] * 3 * speed[axis] ** 2 / reach[axis]
    if axis == 0:
        effort = max(effort, 4 * inertia[0])
    joint: dict[str, float] = {"ratio": float(rng.choice([30, 50, 60, 80, 100, 120]))}
    gear = joint["ratio"]
    if levered:
        joint |= _lever(rng, centre[axis])
        qp = math.sqrt(joint["l1"] ** 2 + joint["l2"] ** 2 - 2 * joint["l1"] * joint["l2"] * math.cos(1.55))
        gear = joint["l1"] * joint["l2"] * math.sin(1.55) / qp / joint["per_rad"]
    dry = effort * rng.uniform(0.08, 0.2) / gear
    rotor = rounded(inertia[axis] * rng.uniform(0.2, 0.8) / gear**2, 3)
    kt = rounded(effort / gear / rng.uniform(2, 5), 3)
    resistance, slow = rng.uniform(0.5, 2), rng.uniform(1e-3, 2e-3)
    loop, fast = 2 * math.pi * rng.uniform(12, 35), 2 * math.pi * rng.uniform(150, 350)
    moved = inertia[axis] / gear**2 + rotor
    limit = 3.0 * effort / gear / kt
    joint |= {
        "inertia": rotor,
        "kt": kt,
        "coulomb": dry,
        "viscous": dry * rng.uniform(0.3, 1.0) / (gear * speed[axis]),
        "kp": loop / 4,
        "kv": loop * moved / kt,
        "ki": loop**2 / 5 * moved / kt,
        "limit": limit,
        "resolution": 2 * math.pi / 2.0 ** rng.integers(16, 21),
        "filter": rng.uniform(0.2, 0.6),
        "resistance": resistance,
        "inductance": resistance * slow,
        "current_p": resistance * slow * fast,
        "current_i": resistance * fast,
        "voltage": 1.3 * resistance * limit + kt * gear * 2 * speed[axis],
    }
    return joint, dry


def _lever(rng: np.random.Generator, middle: float) -> dict[str, float]:
    """Lever whose mid-stroke is where the joint's motion is; a screw between it and the motor."""
    l1, l2 = rounded(rng.uniform(0.2, 0.35), 3), rounded(rng.uniform(0.06, 0.1), 3)
    rev = float(rng.choice([-1, 1]))
    ends = [math.sqrt(l1**2 + l2**2 - 2 * l1 * l2 * math.cos(u)) for u in (0.3, 2.8)]
    return {
        "levered": 1.0,
        "l1": l1,
        "l2": l2,
        "rev": rev,
        "angle": rounded(middle - rev * 1.55, 4),
        "length0": rounded(ends[0], 5),
        "per_rad": float(rng.choice([0.002, 0.004, 0.005])) / (2 * math.pi),
    }


def striking(rng: np.random.Generator, world: World) -> World:
    """The same arm whose dry friction falls with the speed at one joint, as its user knows."""
    number = int(rng.integers(1, len(world.axes) + 1))
    axis = world.axes[number - 1]
    joint = world.joints[axis]
    gear = abs(float(motor(joint, world.centre[axis : axis + 1])[1][0]))
    values = {
        "excess": world.scale[axis] * rng.uniform(0.1, 0.3),
        "sped": rounded(gear * world.speed[axis] * rng.uniform(0.05, 0.2), 3),
        "shape": float(rng.choice([1.0, 2.0])),
    }
    effects = list(world.effects)
    effects[number - 1] = (*effects[number - 1], "stribeck_friction")
    return replace(world.joint(number, **values), effects=tuple(effects))
