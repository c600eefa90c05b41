"""Parts of equations that no arm and no log has."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from arms_support import base_vector, standard_vector
from numpy.random import default_rng

from modelgen.dataset import Record
from modelgen.description import Arm, DirectDrive, EffectUse, Joint
from modelgen.diagnosis.equations import Equations, Rows, Unknowns
from modelgen.diagnosis.evidence import System
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.effects import CATALOGUE
from modelgen.evaluation import Evaluator, Motion
from modelgen.functions import Model, build_model
from modelgen.functions.options import EVALUATED
from modelgen.numeric import Array

UNUSED: Any = None  # records, of which nothing is asked
BARE = Unknowns(np.zeros(0), np.zeros((0, 0)))  # of which nothing is told

EFFECTS = tuple(EffectUse(n) for n in ("viscous_friction", "coulomb_friction", "drive_inertia"))

ARM = Arm(
    "bench",
    (
        Joint("j1", "revolute", drive=DirectDrive(80.0, 0.05), effects=EFFECTS),
        Joint("j2", "revolute", d=0.45, antecedent=0, drive=DirectDrive(60.0, 0.04), effects=EFFECTS),
    ),
    (None, None),
    (0.0, -9.81, 0.0),
)


@cache
def bench() -> tuple[Model, Evaluator]:
    return build_model(ARM, EVALUATED), Evaluator(ARM)


def record(effect: str | None, joint: int, size: float, seed: int, name: str) -> Record:
    """Three periods of five harmonics at 250 Hz, the current with 3 % of white noise."""
    random = np.random.default_rng(seed)
    t = np.arange(0.0, 30.0, 0.004)
    a, b = random.uniform(-0.5, 0.5, (2, 2, 5)) / (1 + np.arange(5))
    w = 2 * np.pi * 0.1 * (1 + np.arange(5))
    phase = np.multiply.outer(t, w)
    q = np.cos(phase) @ a.T + np.sin(phase) @ b.T
    dq = (np.cos(phase) * w) @ b.T - (np.sin(phase) * w) @ a.T
    ddq = -(np.cos(phase) * w**2) @ a.T - (np.sin(phase) * w**2) @ b.T
    model, evaluator = bench()
    base = base_vector(model, standard_vector(model, np.random.default_rng(5)))
    motion = Motion(t, q, dq, ddq)
    given = evaluator.inputs(motion, base)
    if effect is not None:
        values = {"velocity": 8.0, "magnitude": size, "coefficient": size, "stiffness": size, "harmonic": 2.0}
        values |= {"sine": size, "cosine": 0.0, "preload": 0.0, "offset": size}
        own = {p.name for p in (*CATALOGUE[effect].linear, *CATALOGUE[effect].nonlinear)}
        known = {k: v for k, v in values.items() if k in own}
        given = given + evaluator.contribution(effect, joint, motion, known, base)
    given = given + 0.03 * np.sqrt((given**2).mean(axis=0)) * random.normal(size=given.shape)
    ratio = np.array([80.0, 60.0])
    return Record(name, t, q, q * ratio, given, np.ones_like(q), ("A", "A"), motor_side=(True, True), arm=ARM)


def three(effect: str | None, joint: int, size: float, seed: int = 0) -> list[Record]:
    return [record(effect, joint, size, 10 * seed + k, f"r{k}") for k in range(3)]


COUNT = 2 * np.pi / 2**13


def coarse(record: Record, count: float = COUNT) -> Record:
    """Seen by encoders at the joints, in steps of `count` [rad]."""
    q = np.round(record.q / count) * count
    return replace(record, q=q, motor=q * np.array([80.0, 60.0]), motor_side=(False, False))


def equations_of(rows: Sequence[Rows], periods: Sequence[int | None] | None = None) -> Equations:
    """Equations of which all is known, of no arm. periods: by default nothing repeats."""
    return Equations(UNUSED, UNUSED, rows, [None] * len(rows) if periods is None else periods, USUAL)


def system_of(
    rows: Sequence[Rows],
    columns: Sequence[Array] | None = None,
    periods: Sequence[int | None] | None = None,
    noise: Any = None,
) -> System:
    """The same as a system. columns: (M, n, p) of each record, by default the rows' own."""
    return System(equations_of(rows, periods), columns, noise)


PERIOD, PERIODS = 200, 3


def positions(seed: int) -> Array:
    """Of one joint, (PERIOD * PERIODS, 1): every period the same, other records other motions."""
    phase = 2 * np.pi * np.arange(PERIOD) / PERIOD
    sizes = default_rng([1, seed]).normal(size=(2, 4))
    waves = [a * np.cos(k * phase) + b * np.sin(k * phase) for k, (a, b) in enumerate(sizes.T, start=1)]
    return np.tile(np.sum(waves, axis=0), PERIODS)[:, None]


def made(force: Any, seed: int = 0) -> tuple[list[Rows], list[Array], list[int | None]]:
    """Two records of one joint: a mass, a spring of unit stiffness, noise of unit size, a hidden force."""
    rows, q = [], [positions(2 * seed), positions(2 * seed + 1)]
    for k, x in enumerate(q):
        columns = np.column_stack([x, np.gradient(np.gradient(x[:, 0]))])
        noise = default_rng([2, seed, k]).normal(size=len(x))
        effort = columns.sum(axis=1) + force(x[:, 0]) + noise
        flags = np.ones((len(x), 1), dtype=bool)
        rows.append(Rows(UNUSED, effort[:, None], columns[:, None, :], flags, BARE))
    return rows, q, [PERIOD, PERIOD]


def offset(x: Array) -> Array:
    """A law with one parameter."""
    return np.full(len(x), 0.6)


def cubic(x: Array) -> Array:
    """A law with one parameter."""
    return np.asarray(x**3)
