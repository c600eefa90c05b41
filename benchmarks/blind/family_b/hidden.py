"""Effects of the catalogue, put into the plant's own equations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from blind.family_b.equations import motor, still
from blind.family_b.plan import Plan
from blind.family_b.world import World

Numbers = np.random.Generator


@dataclass(frozen=True)
class Hidden:
    """Something hidden, by its strength.

    effect: name in the catalogue, or "outside"; joints: numbers that are right for it.
    at: joint at which its size is measured, None for all together.
    put: the world with it, at a strength; values: its true values; text: its law.
    known: what the user believes where that is less than the world without the effect; the world itself else.
    start, low, high: strength to begin with, and its range; free: the range where no size is asked for.
    """

    effect: str
    joints: tuple[int | None, ...]
    at: int | None
    put: Callable[[float], World]
    values: Callable[[float], dict[str, float]]
    text: str
    known: World | None = None
    start: float = 0.2
    low: float = 1e-4
    high: float = 20.0
    free: tuple[float, float] = (0.05, 0.5)


Maker = Callable[[Numbers, World, Plan, int], Hidden]


def gear(world: World, number: int) -> float:
    """Turns of the motor by turns of the joint, in the middle of the range."""
    axis = world.axes[number - 1]
    return abs(float(motor(world.joints[axis], world.centre[axis : axis + 1])[1][0]))


def fast(world: World, number: int) -> float:
    """Typical speed of the motor [rad/s]."""
    return gear(world, number) * float(world.speed[world.axes[number - 1]]) * 0.4


def dry(world: World, number: int) -> float:
    """Dry friction at the motor [N m], to scale effects by."""
    return float(world.scale[world.axes[number - 1]])


def load(world: World, number: int) -> float:
    """Largest weight that the transmission bears, at the motor [N m]."""
    axis = world.axes[number - 1]
    return float(still(world.arm, world.centre, world.reach)[1][axis]) / gear(world, number)


def sign(rng: Numbers) -> float:
    """Either way, drawn."""
    return float(rng.choice([-1, 1]))
