"""Arms drawn by seed."""

from __future__ import annotations

import math
from dataclasses import replace

import mujoco
import numpy as np

from blind.case import Array
from blind.family_c.arms import Lever, Link, World
from blind.family_c.plant import build, frame

GRAVITY = 9.81
COUNTS, SHARES = (2, 3, 4, 5, 6), (0.3, 0.35, 0.15, 0.1, 0.1)  # of joints
SLIDES = 0.25  # share of the arms of three joints and more with one that slides
LEVERED = 0.4  # share of the arms with levers
TILTED = 0.3  # share of the arms whose base is mounted aslant, as described
POSES = 80  # by which drives are sized
Numbers = np.random.Generator


def rounded(x: float, digits: int = 4) -> float:
    """A number as it stands in a description."""
    return float(f"{x:.{digits}g}")


def count(rng: Numbers, least: int = 2) -> int:
    """How many joints an arm has."""
    return max(least, int(rng.choice(COUNTS, p=SHARES)))


def draw(rng: Numbers, joints: int, levered: bool | None = None) -> World:
    """Arm of so many joints. levered: whether it has a lever at least; None: as it comes."""
    levered = bool(rng.random() < LEVERED) if levered is None else levered
    sliding = int(rng.integers(1, joints)) if joints > 2 and rng.random() < SLIDES else -1
    shapes = [_joint(rng, k, k == sliding) for k in range(joints)]
    links = tuple(_link(rng, k, shapes) for k in range(joints))
    turning = [k for k in range(joints) if k != sliding]
    crossed: set[int] = set()
    if levered:
        crossed = {
            int(k) for k in rng.choice(turning, min(len(turning), int(rng.integers(1, 3))), replace=False)
        }
    centre = np.where(
        np.arange(joints) == sliding, rng.uniform(0.05, 0.15, joints), rng.uniform(-1, 1, joints)
    )
    reach = np.where(
        np.arange(joints) == sliding, rng.uniform(0.08, 0.15, joints), rng.uniform(0.5, 1.0, joints)
    )
    speed = np.where(
        np.arange(joints) == sliding, rng.uniform(0.15, 0.35, joints), rng.uniform(0.8, 1.8, joints)
    )
    for k in crossed:
        reach[k] = min(reach[k], 0.85)
    levers = tuple(_lever(rng, float(centre[k])) if k in crossed else None for k in range(joints))
    numbers = tuple(_gear(rng, levers[k], k == sliding) for k in range(joints))
    slant, about = rng.uniform(0.1, 0.7), rng.uniform(0, 2 * math.pi)
    gravity = (0.0, 0.0, -GRAVITY)
    if rng.random() < TILTED:
        side = GRAVITY * math.sin(slant)
        gravity = (
            rounded(side * math.cos(about)),
            rounded(side * math.sin(about)),
            rounded(-GRAVITY * math.cos(slant)),
        )
    world = World(
        links, levers, (0.0,) * joints, numbers, gravity, centre, reach, speed, np.zeros(joints),
        (("viscous_friction", "coulomb_friction", "drive_inertia"),) * joints,
    )  # fmt: skip
    return _drives(rng, world)


def _joint(rng: Numbers, k: int, slides: bool) -> tuple[float, float, float, float, bool]:
    """alpha, d, theta, r of a joint, and whether it slides."""
    if k == 0:
        alpha = float(rng.choice([0.0, 0.0, math.pi / 2, rounded(rng.uniform(-0.8, 0.8), 3)]))
    elif rng.random() < 0.6:
        alpha = float(rng.choice([0.0, math.pi / 2, -math.pi / 2]))
    else:
        alpha = rounded(rng.uniform(-1.4, 1.4), 3)
    shrink = 0.85**k
    far = k > 0 and (abs(alpha) < 0.3 or rng.random() < 0.75)
    d = rounded(rng.uniform(0.15, 0.4) * shrink, 3) if far else 0.0
    r = rounded(rng.uniform(-0.1, 0.25) * shrink, 3) if k and rng.random() < 0.4 else 0.0
    theta = rounded(rng.uniform(-3, 3), 3) if rng.random() < 0.3 else 0.0
    return alpha, d, theta, r, slides


def _link(rng: Numbers, k: int, shapes: list[tuple[float, float, float, float, bool]]) -> Link:
    alpha, d, theta, r, slides = shapes[k]
    if k + 1 < len(shapes):
        a, dd, _, rr, _ = shapes[k + 1]
        end = np.array([dd, -rr * math.sin(a), rr * math.cos(a)])
    else:
        end = np.array([rng.uniform(0.1, 0.25), rng.uniform(-0.05, 0.05), rng.uniform(-0.05, 0.1)])
    mass = rounded(rng.uniform(4, 10) * 0.65**k)
    com = [rounded(x, 3) for x in end * rng.uniform(0.25, 0.6) + rng.uniform(-0.03, 0.03, 3)]
    spread = rng.normal(size=(3, 3)) * rng.uniform(0.02, 0.05)
    covariance = np.outer(end, end) / 12 * rng.uniform(0.7, 1.4) + spread @ spread.T + 4e-4 * np.eye(3)
    inertia = mass * (np.trace(covariance) * np.eye(3) - covariance)  # that of any cloud of masses
    rows = [[rounded(float(x), 5) for x in row] for row in inertia]
    tensor = tuple((row[0], row[1], row[2]) for row in rows)
    return Link(alpha, d, theta, r, slides, mass, (com[0], com[1], com[2]), tensor)


def _lever(rng: Numbers, middle: float) -> Lever:
    """Actuator whose two ends are seen at a right angle, about, in the middle of the motion."""
    l1, l2 = rounded(rng.uniform(0.18, 0.35), 3), rounded(rng.uniform(0.05, 0.1), 3)
    if rng.random() < 0.3:
        l1, l2 = l2, l1
    rev = int(rng.choice([-1, 1]))
    angle = rounded(middle - rev * rng.uniform(1.5, 1.65), 4)
    ends = [math.sqrt(l1**2 + l2**2 - 2 * l1 * l2 * math.cos(u)) for u in (0.35, 2.75)]
    return Lever(l1, l2, rev, angle, rounded(ends[0], 5), rounded(ends[1], 5))


def _gear(rng: Numbers, lever: Lever | None, slides: bool) -> dict[str, float]:
    if lever is not None:
        return {"scale": 2 * math.pi / float(rng.choice([2e-3, 3e-3, 5e-3])), "length0": lever.shortest}
    if slides:
        return {"scale": 2 * math.pi / float(rng.choice([5e-3, 1e-2, 2e-2])), "length0": 0.0}
    return {"scale": float(rng.choice([35, 50, 64, 80, 101, 121, 160])), "length0": 0.0}


def efforts(model: mujoco.MjModel, q: Array, v: Array, a: Array) -> Array:
    """Joint efforts (N, n) of the links alone, by MuJoCo's recursion of Newton and Euler. q, v, a: (N, n)."""
    data, out = mujoco.MjData(model), np.empty_like(q)
    for k, row in enumerate(zip(q, v, a, strict=True)):
        data.qpos[:], data.qvel[:], data.qacc[:] = row
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        mujoco.mj_rne(model, data, 1, out[k])
    return out


def inertias(world: World) -> Array:
    """Inertia of the links at each joint (n), in the middle of the motion."""
    n = world.count
    rows = efforts(build(world), np.tile(world.centre, (n + 1, 1)), np.zeros((n + 1, n)), np.eye(n + 1, n))
    own: Array = np.diag(rows[:n] - rows[n])
    return own


def _drives(rng: Numbers, world: World) -> World:
    """The same arm with drives of the right size, and their loops."""
    n = world.count
    at = rng.uniform(-1, 1, (3, POSES, n))
    hasty = 3 * world.speed**2 / world.reach
    loads = efforts(
        build(world), world.centre + at[0] * world.reach, at[1] * world.speed, at[2] * hasty
    )  # fmt: skip
    inertia = inertias(world)
    peaks = np.maximum(np.abs(loads).max(axis=0), 2 * inertia * hasty)
    numbers, rotors, dry = [], [], []
    for k in range(n):
        gear = world.middle_gear(k)
        peak = float(peaks[k]) / gear
        rotor = rounded(float(inertia[k]) * rng.uniform(0.2, 0.8) / gear**2, 3)
        kt = rounded(peak / rng.uniform(2, 8), 3)
        moved = float(inertia[k]) / gear**2 + rotor
        quick = 2 * math.pi * rng.uniform(12, 22)
        dry.append(peak * rng.uniform(0.06, 0.18))
        rotors.append(rotor)
        numbers.append({
            **world.numbers[k],
            "kt": kt,
            "lag": rng.uniform(3e-4, 1e-3),
            "limit": 4 * peak / kt,
            "grain": 2 * math.pi / 2.0 ** rng.integers(18, 23),
            "filter": rng.uniform(0.4, 0.9),
            "kp": moved * quick**2 / kt,
            "kd": moved * 2 * rng.uniform(0.7, 1.1) * quick / kt,
            "ki": moved * quick**3 / rng.uniform(5, 12) / kt,
            "forward": moved * rng.uniform(0, 1) / kt,
            "coulomb": dry[k],
            "viscous": dry[k] * rng.uniform(0.2, 1.0) / (gear * world.speed[k]),
        })  # fmt: skip
    return replace(world, numbers=tuple(numbers), rotors=tuple(rotors), scale=np.array(dry))


def tip(world: World) -> Array:
    """A point at the end of the last link, in its frame [m]: twice as far as its centre of mass."""
    return 2 * np.array(world.links[-1].com)


def origin(world: World) -> Array:
    """Where that point is in the base's frame, in the middle of the motion [m]."""
    p, turn = np.zeros(3), np.eye(3)
    for k, link in enumerate(world.links):
        place, rotated = frame(link)
        p, turn = p + turn @ place, turn @ rotated
        if link.slides:
            p = p + turn[:, 2] * world.centre[k]
        else:
            c, s = math.cos(world.centre[k]), math.sin(world.centre[k])
            turn = turn @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    out: Array = p + turn @ tip(world)
    return out
