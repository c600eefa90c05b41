"""What is hidden, by its strength, and the scales that strengths are counted in."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from blind.family_c.arms import World
from blind.family_c.plan import Plan

Numbers = np.random.Generator


@dataclass(frozen=True)
class Hidden:
    """Something hidden. Joints count from 0 here, from 1 in the truth.

    effect: name in the catalogue, or "outside"; joints: where it is right to name it, None for the whole arm.
    at: joint at which its size is measured, None for all together.
    put: the world with it, at a strength; values: its true values; text: its law in words.
    believed: what the user describes where that is less than the world without the effect; that world else.
    start, least, most: strength to begin with, and its range; free: the range where no size is asked for.
    """

    effect: str
    joints: tuple[int | None, ...]
    at: int | None
    put: Callable[[float], World]
    values: Callable[[float], dict[str, float]]
    text: str
    believed: World | None = None
    start: float = 0.15
    least: float = 1e-4
    most: float = 20.0
    free: tuple[float, float] = (0.05, 0.5)


Maker = Callable[[Numbers, World, Plan, int], Hidden]


def fast(world: World, k: int) -> float:
    """Typical speed of the motor of joint k [rad/s]."""
    return world.middle_gear(k) * float(world.speed[k]) * 0.4


def dry(world: World, k: int) -> float:
    """Dry friction of the motor of joint k [N m], whether the description has it or not."""
    return float(world.scale[k])


def effort(world: World, k: int) -> float:
    """The same at the joint [N m or N]."""
    return dry(world, k) * world.middle_gear(k)


def sign(rng: Numbers) -> float:
    """Either way, drawn."""
    return float(rng.choice([-1, 1]))
