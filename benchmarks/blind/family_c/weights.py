"""What the joints of an arm bear at rest."""

from __future__ import annotations

import numpy as np

from blind.case import Array
from blind.family_c.arms import World
from blind.family_c.draw import efforts
from blind.family_c.plant import build

POSES = 60


def heaviest(world: World) -> Array:
    """Largest effort (n) of the links' weight in the range of the motion."""
    at = np.random.default_rng(0).uniform(-1, 1, (POSES, world.count))
    q = world.centre + at * world.reach
    still = np.zeros_like(q)
    most: Array = np.abs(efforts(build(world), q, still, still)).max(axis=0)
    return most
