"""The arm at work, and what a logger writes of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from blind.case import Array, Table
from blind.family_b import kernel, motion
from blind.family_b.description import unit
from blind.family_b.equations import carrying, joint_angle, motor
from blind.family_b.plan import Plan, motor_grain
from blind.family_b.world import World

SETTLE = 2.0  # s before a record begins
TAIL = 0.02  # s after its end
APART = 1e3  # s between records, for what depends on absolute time
LEVELS = 4096  # of the current's converter, over its range
BY_STEP = round(1 / kernel.STEP)


@dataclass(frozen=True)
class Record:
    """A record as it is fitted, times (N), angles read (N, 3), currents (N, 3), and as it is written."""

    t: Array
    q: Array
    i: Array
    table: Table


def command(world: World, plan: Plan, seed: int, k: int) -> Array:
    """Angles of record k (ticks, 3) that the loops follow, from SETTLE before its begin."""
    rng = np.random.default_rng([seed, 17, k])
    times = np.arange(round((SETTLE + plan.seconds + TAIL) / kernel.TICK)) * kernel.TICK - SETTLE
    span = (world.centre, world.reach, world.speed)
    if plan.period is not None:
        angles = motion.fourier(rng, span, plan.period, times)
    else:
        angles = motion.ordinary(rng, str(rng.choice(motion.ORDINARY)), span, times)
    if world.arm["locked"]:  # where the description has its base, in every record
        angles[:, 0] = 0.0
    return angles


def record(world: World, plan: Plan, seed: int, k: int, angles: Array, heat: Array) -> tuple[Record, Array]:
    """Record k of the arm, with the heat that its drives begin with (3), and that they end with.

    angles: what `command` says. Raises kernel.Unstable.
    """
    arm = world.arm
    if world.payload is not None and k == plan.train - 1:
        arm = carrying(arm, world.payload)
    places = [motor(joint, angles[:, axis])[0] for axis, joint in enumerate(world.joints)]
    m = np.stack(places, axis=1)
    reference = np.concatenate([m, np.gradient(m, kernel.TICK, axis=0)], axis=1)
    times = np.arange(len(angles)) * kernel.TICK - SETTLE + APART * k
    log, warm = kernel.run(
        arm,
        list(world.joints),
        reference,
        begin=round(SETTLE / kernel.TICK),
        push=None if world.push is None else world.push(times),
        gain=None if world.gain is None else world.gain(times - APART * k),
        start=np.concatenate([angles[0], np.zeros(3)]),
        heat=heat,
    )
    return _read(world, plan, np.random.default_rng([seed, 29, k]), k, log), warm


def _read(world: World, plan: Plan, rng: np.random.Generator, k: int, log: Array) -> Record:
    stride = BY_STEP // plan.rate
    rows = np.arange(round(plan.seconds * plan.rate))
    taken = round(SETTLE * BY_STEP) + stride * (rows - rows % plan.repeats)
    t = rows / plan.rate
    noise = rng.normal(size=(len(rows), 3))[rows - rows % plan.repeats]
    q, current = np.empty((len(rows), 3)), np.empty((len(rows), 3))
    stamps = t + k * plan.seconds if plan.on_and_on else t
    table: Table = {"t": np.round(stamps, 7)}
    for axis, joint in enumerate(world.joints):
        flow = _flow(log[:, 6 + axis], taken, stride, plan, world.late)
        flow = flow + plan.noise * joint["limit"] / 6 * noise[:, axis]
        grain = 2 * joint["limit"] / LEVELS
        current[:, axis] = np.round(flow / grain) * grain
        true = log[taken, axis] - world.offset[axis]
        if plan.sides[axis] == "motor":
            place = motor(joint, true)[0] if world.offset[axis] else log[taken, 3 + axis]
            grain = motor_grain(plan, axis)
            q[:, axis] = np.round(place / grain) * grain
        else:
            grain = 2 * np.pi / 2 ** plan.bits[axis]
            q[:, axis] = np.round(true / grain) * grain
    for number, axis in enumerate(world.axes, start=1):
        joint = world.joints[axis]
        if plan.sides[axis] == "motor":
            written = q[:, axis] * unit(world, plan, axis)
            table[f"qm{number}"] = np.round(written) if joint.get("levered") else written
        else:
            table[f"q{number}"] = q[:, axis]
        table[f"i{number}"] = current[:, axis]
    return Record(t, q, current, table)


def _flow(current: Array, taken: Array, stride: int, plan: Plan, late: float) -> Array:
    """Current of the rows: at an instant, or its mean over an interval."""
    at = taken - late / kernel.STEP
    if plan.timing in ("previous", "following"):
        total = np.concatenate([[0.0], np.cumsum(current)])
        first = at - stride if plan.timing == "previous" else at
        grid = np.arange(len(total))
        mean: Array = (np.interp(first + stride, grid, total) - np.interp(first, grid, total)) / stride
        return mean
    return np.interp(at + plan.shift / kernel.STEP, np.arange(len(current)), current)


def as_believed(world: World, plan: Plan, taken: Record) -> Array:
    """Joint angles (N, 3) that the user computes from a record. world: as the user believes it to be."""
    q = taken.q.copy()
    for axis, joint in enumerate(world.joints):
        if plan.sides[axis] == "motor":
            q[:, axis] = joint_angle(joint, q[:, axis])
    return q
