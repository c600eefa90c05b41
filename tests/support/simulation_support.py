"""Plants for the simulation's tests: shipped arms with bodies that could exist, and pendulums."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

import numpy as np
from arms_support import ARMS, standard_vector
from witness.bodies import Body

from modelgen.description import Arm, EffectUse, Inertial, Joint
from modelgen.errors import InputError
from modelgen.functions import grouped
from modelgen.simulation import Plant, plant
from modelgen.simulation.friction_set import Slip, slip

KEPT = 4  # of the arms that were asked for last
_slips: list[tuple[Arm, Slip]] = []


def slip_of(arm: Arm) -> Slip:
    """The functions of an arm, made once for tests that follow each other; it is found by its identity."""
    for known, made in _slips:
        if known is arm:
            return made
    _slips.append((arm, slip(arm)))
    del _slips[:-KEPT]
    return _slips[-1][1]


@cache
def shipped(name: str, seed: int = 1) -> Plant:
    """A shipped arm with its nominal values, random ones where the description has none; built once."""
    try:
        return plant(ARMS[name])
    except InputError:
        made = slip_of(ARMS[name])
        standard = standard_vector(made.model, np.random.default_rng(seed))
        return of_base(made, list(grouped(made.model, standard.tolist()).values()))


def middle(plant: Plant, otherwise: float = 0.3) -> np.ndarray:
    """The middle of the strokes, else of the limits."""
    found = np.full(plant.n, otherwise)
    for low, high in (plant.limits, plant.strokes):
        known = np.isfinite(low) & np.isfinite(high)
        found[known] = (low[known] + high[known]) / 2
    return found


def with_bodies(arm: Arm, bodies: Sequence[Body], effects: dict[str, np.ndarray]) -> Plant:
    """The arm with these links; effects: standard parameters of the effects by symbol, by coordinate."""
    made = slip_of(arm)
    numbers = [str(i + 1) for i in arm.coordinates]
    values = {
        f"{symbol}{k}": x for symbol, all_ in effects.items() for k, x in zip(numbers, all_, strict=True)
    }
    ten = ("XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M")
    for i, body in enumerate(bodies):
        values |= {f"{t}{i + 1}": x for t, x in zip(ten, body.ten, strict=True)}
    standard = [float(values[p.name]) for p in made.model.standard]
    return of_base(made, list(grouped(made.model, standard).values()))


def of_base(made: Slip, values: Sequence[float]) -> Plant:
    """A plant with these base parameters."""
    return Plant(made, np.array(values), np.array(values))


def pendulum(*effects: EffectUse, mass: float = 2.0, length: float = 0.4) -> Arm:
    """A point mass on a rod that swings about a level axis; q = 0 hangs."""
    inertial = Inertial(mass, (length, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    joint = Joint("swing", "revolute", effects=effects)
    return Arm("pendulum", (joint,), (inertial,), gravity=(9.81, 0.0, 0.0))


def slider(*effects: EffectUse, mass: float = 2.0) -> Arm:
    """A mass on a level rail."""
    inertial = Inertial(mass, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    joint = Joint("slide", "prismatic", effects=effects)
    return Arm("slider", (joint,), (inertial,), gravity=(9.81, 0.0, 0.0))
