"""The arm at work, and what a logger writes of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

from blind.case import Array, Table
from blind.family_c import motion, plant
from blind.family_c.arms import World
from blind.family_c.plan import Plan

SETTLE = 2.0  # s before a record begins
TAIL = 0.02  # s after its end
APART = 1e3  # s between records, for what depends on absolute time
LEVELS = 8192  # of the current's converter, over its range
BY_SECOND = round(1 / plant.STEP)


@dataclass(frozen=True)
class Record:
    """A record as it is fitted: times (N), coordinates that the user computes (N, n), currents (N, n)."""

    t: Array
    q: Array
    i: Array
    read: Array  # (N, n) what the encoders say: joints' coordinates, or motors' angles [rad]


def command(world: World, plan: Plan, seed: int, k: int) -> Array:
    """Joint coordinates of record k (ticks, n) that the loops follow, from SETTLE before its begin."""
    rng = np.random.default_rng([seed, 5, k])
    ticks = round((SETTLE + plan.seconds + TAIL) / plant.TICK)
    times = np.arange(ticks) * plant.TICK - SETTLE
    span = (world.centre, world.reach, world.speed)
    if plan.period is not None:
        return motion.periodic(rng, span, plan.period, plan.orders, times)
    return motion.work(rng, str(rng.choice(motion.WORK)), span, times)


def flown(world: World, plan: Plan, k: int, commanded: Array) -> Array:
    """Joints, motors and currents of every step of record k (steps, 3 n). Raises plant.Unstable."""
    times = np.arange(len(commanded)) * plant.TICK - SETTLE + APART * k
    push, gain = np.zeros_like(commanded), np.ones_like(commanded)
    for joint, law in world.pushes.items():
        push[:, joint] = law(times)
    for joint, law in world.gains.items():
        gain[:, joint] = law(times)
    reference = np.stack([world.motor(j, commanded[:, j]) for j in range(world.count)], axis=1)
    return plant.run(
        world, reference, start=commanded[0], begin=round(SETTLE / plant.TICK), push=push, gain=gain,
        carrying=k == plan.train - 1,
    )  # fmt: skip


def levels(world: World, plan: Plan, seed: int) -> Array:
    """RMS of each joint's current (n) at the first motion, by which noise is scaled."""
    log = flown(world, plan, -1, command(world, plan, seed, 0))
    rms: Array = np.sqrt(np.mean(log[round(SETTLE * BY_SECOND) :, 2 * world.count :] ** 2, axis=0))
    return rms


def record(
    world: World, believed: World, plan: Plan, seed: int, k: int, commanded: Array, noise: Array
) -> Record:
    """Record k, as the user of `believed` reads it. noise: RMS (n) of currents. Raises plant.Unstable."""
    log, n = flown(world, plan, k, commanded), world.count
    stride = BY_SECOND // plan.rate
    t = np.arange(round(plan.seconds * plan.rate)) / plan.rate
    taken = round(SETTLE * BY_SECOND) + stride * np.arange(len(t))
    rng = np.random.default_rng([seed, 7, k])
    current, read, q = np.empty((len(t), n)), np.empty((len(t), n)), np.empty((len(t), n))
    fade = np.exp(-1 / (plan.rate * plan.memory))
    for j in range(n):
        white, driven = rng.normal(size=(2, len(t)))
        coloured = lfilter([np.sqrt(1 - fade**2)], [1, -fade], driven)
        flow = _flow(log[:, 2 * n + j], taken, stride, plan, world.late)
        flow = flow + noise[j] * (plan.white * white + plan.coloured * coloured)
        step = 2 * world.numbers[j]["limit"] / LEVELS
        current[:, j] = np.round(flow / step) * step
        read[:, j] = _read(world, plan, j, log[taken, j], log[taken, n + j])
        q[:, j] = believed.place(j, read[:, j]) if plan.motor_side[j] else read[:, j]
    return Record(t, q, current, read)


def _read(world: World, plan: Plan, j: int, joint: Array, motor: Array) -> Array:
    """What the encoder of a joint says."""
    said = joint - (world.offset[j] if world.offset else 0.0)
    if world.eccentric is not None and world.eccentric[0] == j:
        said = said + world.eccentric[1] * np.sin(said + world.eccentric[2])
    grain = plan_grain(world, plan, j)
    if plan.motor_side[j]:
        changed = world.offset or world.eccentric is not None
        said = world.motor(j, said) if changed and world.elastic is None else motor
    counted: Array = np.round(said / grain) * grain
    return counted


def plan_grain(world: World, plan: Plan, j: int) -> float:
    """Increment of the logged encoder of a joint [rad, or m where it reads a sliding joint]."""
    turn = 0.1 if world.links[j].slides and not plan.motor_side[j] else 2 * np.pi
    return float(turn / 2 ** plan.bits[j])


def _flow(current: Array, taken: Array, stride: int, plan: Plan, late: float) -> Array:
    """Current of the rows: at an instant, or its mean over the time to the next or from the last position."""
    if plan.hold not in ("previous", "following"):
        at = taken + (plan.shift - late) / plant.STEP
        return np.interp(at, np.arange(len(current)), current)
    first = taken - late / plant.STEP - (stride if plan.hold == "previous" else 0)
    charge, grid = np.concatenate([[0.0], np.cumsum(current)]), np.arange(len(current) + 1)
    mean: Array = (np.interp(first + stride, grid, charge) - np.interp(first, grid, charge)) / stride
    return mean


def table(world: World, plan: Plan, taken: Record) -> Table:
    """Columns of a record as they are written, in the units that the mapping names."""
    out: Table = {"time": np.round(taken.t, 7)}
    for j in range(world.count):
        out[f"pos_{j + 1}"] = taken.read[:, j] / unit(world, plan, j)[1] + start(world, plan, j)
        out[f"cur_{j + 1}"] = taken.i[:, j] * 1e3
    return out


def start(world: World, plan: Plan, j: int) -> float:
    """What is written where the reading is 0: a linear actuator's shortest length [mm], 0 else."""
    lever = world.levers[j]
    return 0.0 if lever is None or not plan.motor_side[j] else lever.shortest * 1e3


def unit(world: World, plan: Plan, j: int) -> tuple[str, float]:
    """Unit of a written position, and how much of the reading it is [rad, or m at a sliding joint]."""
    if plan.motor_side[j]:
        return ("mm", world.numbers[j]["scale"] * 1e-3) if world.levers[j] is not None else ("rev", 2 * np.pi)
    return ("mm", 1e-3) if world.links[j].slides else ("deg", np.pi / 180)
