"""Cases drawn from a seed: an arm, a joint and a magnitude at which the effects have the strength wanted."""

from __future__ import annotations

import zlib
from dataclasses import replace

import numpy as np
from numpy.random import default_rng

from hidden import arms
from hidden.cases import TRAIN, Bench, Case, Hidden
from hidden.effects import joints_for
from hidden.native import PlantError


def draw_arm(effect: str, random: np.random.Generator, names: tuple[str, ...]) -> tuple[str, int]:
    """An arm of those names, and a joint (from 1) of it, that the effect can sit at."""
    possible = [
        (name, joint + 1) for name in names for joint in joints_for(effect, arms.draw(name, default_rng(0)))
    ]
    if not possible:
        raise PlantError(f"{effect} can sit at no joint of {', '.join(names)}")
    having = sorted({name for name, _ in possible})
    name = having[int(random.integers(len(having)))]
    joints = [joint for arm, joint in possible if arm == name]
    return name, joints[int(random.integers(len(joints)))]


def draw(
    seed: int,
    effects: tuple[str, ...],
    strength: float,
    names: tuple[str, ...],
    encoder: str = "motor",
    train: int = TRAIN,
) -> Case:
    """A case whose effects reach the strength wanted, within what a plausible arm allows.

    The seed draws arm and joint, and draws again where the effect hides there (a load of one sign hides
    backlash, a narrow range an offset). The same draw for any number of training records.
    Raises PlantError after some draws.
    """
    random = default_rng([seed, zlib.crc32("+".join(effects).encode()), round(1000 * strength)])
    for attempt in range(12):
        if not effects:
            name = names[int(random.integers(len(names)))]
            return Case(name, seed, (), encoder, train=train)
        name, first = draw_arm(effects[0], random, names)
        arm = arms.draw(name, default_rng(0))
        joints = [first]
        for effect in effects[1:]:
            possible = [j + 1 for j in joints_for(effect, arm)]
            if possible:
                joints.append(possible[int(random.integers(len(possible)))])
        if len(joints) < len(effects):
            continue
        # Counts of a motor that are off by some are a wrong length of the lever: only an encoder at the
        # joint can have an offset of its own.
        side = "joint" if "encoder_offset" in effects and encoder == "motor" else encoder
        carried = seed % 2 == 1  # in one case out of two
        hidden = tuple(Hidden(e, j, strength, carried=carried) for e, j in zip(effects, joints, strict=True))
        case = Case(name, seed + 1000 * attempt, hidden, side)
        bench = Bench(case)
        floor = bench.errors({})
        tuned = [bench.tune(place, floor) for place in range(len(hidden))]
        if all(abs(reached - strength) < 0.25 * (strength - 1.0) for _, reached in tuned):
            known = tuple(
                replace(item, magnitude=magnitude) for item, (magnitude, _) in zip(hidden, tuned, strict=True)
            )
            return Case(name, case.seed, known, side, train=train)
    raise PlantError(f"{' and '.join(effects)} reach {strength:g} on none of the arms drawn with seed {seed}")
