"""Shared by tests of identification."""

from dataclasses import replace

import numpy as np
from arms_support import ARMS
from witness.bodies import Body, random_bodies

import modelgen as mg
from modelgen.description import Arm, Inertial
from modelgen.functions import Options
from modelgen.functions.options import prepared as reduced

RATE = 200.0


KEPT = 4  # of the arms that were asked for last
_models: list[tuple[Arm, mg.Model]] = []


def model_of(arm: Arm) -> mg.Model:
    """The model of an arm, built once for tests that follow each other; it is found by its identity."""
    for known, made in _models:
        if known is arm:
            return made
    _models.append((arm, mg.build_model(arm)))
    del _models[:-KEPT]
    return _models[-1][1]


def tapering(seed: int) -> list[Body]:
    """Links that grow light towards the tool, as an arm's do."""
    bodies = random_bodies(ARMS["rx90"], np.random.default_rng(seed))
    parts = (1.0, 1.0, 0.5, 0.1, 0.03, 0.01)
    return [Body(b.mass * x, b.com, b.inertia * x) for b, x in zip(bodies, parts, strict=True)]


def bare(name: str, bodies: list[Body]) -> Arm:
    """The links of an arm, undriven, described by bodies half as heavy again."""
    arm = reduced(ARMS[name], Options(without=frozenset({"drives", "effects"})))
    links = []
    for body in bodies:
        i = 1.5 * body.inertia
        links.append(
            Inertial(
                1.5 * body.mass,
                (float(body.com[0]), float(body.com[1]), float(body.com[2])),
                (i[0, 0], i[0, 1], i[0, 2], i[1, 1], i[1, 2], i[2, 2]),
            )
        )
    return replace(arm, links=tuple(links))
