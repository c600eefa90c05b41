"""Arms to try: those that ship, and random ones with every kind of joint; their functions in NumPy."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from arms_support import ARMS, model

from modelgen.backends import NumpyFunction
from modelgen.description import (
    Arm,
    DirectDrive,
    Drive,
    EffectUse,
    Joint,
    LeveredDrive,
    NoDrive,
    geometry_symbol,
)
from modelgen.functions import Function, Model, Options, build_model
from witness.geometry import number

# Without derivatives, which have tests of their own and take as long as all the rest.
BARE = Options(without=frozenset({"drives", "effects"}), derivatives=False)
WHOLE = Options(derivatives=False)


class Emitted:
    """An arm's functions, evaluated by the NumPy backend; samples stay the first axis, rows the second."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self.arm = model.arm
        self.functions: dict[str, Function] = {f.name: f for f in model.functions}
        self._compiled: dict[str, NumpyFunction] = {}

    def __call__(self, name: str, *inputs: Any, **named: Any) -> Any:
        """An output of one column keeps its axis where the function's result is a matrix."""
        if name not in self._compiled:
            self._compiled[name] = NumpyFunction(self.functions[name])
        found = self._compiled[name](*inputs, **named)
        outputs = self.functions[name].outputs
        if len(outputs) == 1 and outputs[0].name in ("matrix", "mass", "jacobian"):
            return found.reshape(-1, outputs[0].rows, outputs[0].columns)
        return found

    def base(self, standard: np.ndarray) -> np.ndarray:
        """Base parameters for a standard vector, by the terms of the grouping."""
        return np.array(
            [
                sum(number(self.arm, factor) * standard[k] for k, factor in base.terms)
                for base in self.model.grouping.base
            ]
        )


def build(arm: Arm, options: Options = BARE) -> Emitted:
    """The functions of an arm, drives and effects left out unless `options` say otherwise."""
    return Emitted(build_model(arm, options))


@cache
def shipped(name: str, variant: str = "default") -> Emitted:
    """An arm of arms.yaml, built once a worker. `variant`: as in arms_support, "links" without drives."""
    return Emitted(model(name, variant))


_ANGLES = (0.0, math.pi / 2, -math.pi / 2, math.pi, math.radians(37), -math.radians(103))


def _random_joint(rng: np.random.Generator, i: int) -> Joint:
    kind = str(rng.choice(["revolute", "prismatic", "fixed"], p=[0.65, 0.22, 0.13]))
    alpha = float(rng.choice(_ANGLES)) if rng.random() < 0.8 else float(rng.uniform(-3, 3))
    d, r = (float(rng.uniform(-0.5, 0.5)) if rng.random() < 0.6 else 0.0 for _ in range(2))
    theta = float(rng.choice(_ANGLES)) if rng.random() < 0.5 else 0.0
    antecedent = i - 1 if i else None
    gamma, b = 0.0, 0.0
    if i and rng.random() < 0.25:
        antecedent = int(rng.integers(-1, i))
        antecedent = None if antecedent < 0 else antecedent
        gamma, b = float(rng.choice(_ANGLES)), float(rng.uniform(-0.3, 0.3))
    locked = float(rng.uniform(-1, 1)) if kind != "fixed" and rng.random() < 0.12 else None
    return Joint(f"j{i + 1}", kind, alpha, d, r, theta, gamma, b, antecedent, locked=locked)


def _shuffled(joints: list[Joint], rng: np.random.Generator) -> list[Joint]:
    """The joints in another order of the file."""
    order = rng.permutation(len(joints))
    place = {int(old): new for new, old in enumerate(order)}
    result = [joints[int(old)] for old in order]
    return [
        joint if joint.antecedent is None else replace(joint, antecedent=place[joint.antecedent])
        for joint in result
    ]


def _random_drive(joint: Joint, rng: np.random.Generator) -> Drive:
    constant = float(rng.uniform(0.02, 0.3))
    if joint.type == "prismatic":
        lead = float(rng.uniform(0.005, 0.05))
        return DirectDrive(2 * math.pi / lead, constant) if rng.random() < 0.6 else NoDrive()
    which = rng.random()
    if which < 0.25:
        return NoDrive()
    if which < 0.55:
        return DirectDrive(float(rng.uniform(20, 120) * rng.choice([-1, 1])), constant)
    l1, l2 = sorted(rng.uniform(0.05, 0.5, 2), reverse=bool(rng.random() < 0.7))
    ends = [math.sqrt(l1**2 + l2**2 - 2 * l1 * l2 * math.cos(math.radians(a))) for a in (35, 140)]
    motor = [(0.0, 20000.0), (20000.0, 0.0), (-3.0, 250.0)][int(rng.integers(3))]
    scale = (ends[1] - ends[0]) / abs(motor[1] - motor[0])
    return LeveredDrive(
        float(l1),
        float(l2),
        (ends[0], ends[1]),
        motor,
        int(rng.choice([-1, 1])),
        float(rng.uniform(-2, 2)),
        float(rng.uniform(500, 2000)) * scale,
    )


def _motor_speed(drive: Drive) -> float:
    """About how fast the motor coordinate runs at a joint speed of one."""
    if isinstance(drive, LeveredDrive):
        return abs(drive.motor[1] - drive.motor[0]) / 1.8
    return abs(drive.ratio) if isinstance(drive, DirectDrive) else 1.0


def _random_effects(drive: Drive, rng: np.random.Generator) -> tuple[EffectUse, ...]:
    driven = [] if isinstance(drive, NoDrive) else ["drive_inertia"]
    names = ["viscous_friction", "coulomb_friction", *driven]
    uses = [EffectUse(name) for name in names]
    if rng.random() < 0.3:
        uses.append(EffectUse("friction_offset"))
    if rng.random() < 0.3:
        uses.append(EffectUse("spring"))
    if rng.random() < 0.3:
        slow = float(rng.uniform(0.1, 0.5)) * _motor_speed(drive)
        values = {"velocity": slow, "exponent": float(rng.choice([1.0, 1.5, 2.0]))}
        uses.append(EffectUse("stribeck_friction", values))
    rng.shuffle(uses)  # type: ignore[arg-type]
    return tuple(uses)


def random_arm(seed: int, dressed: bool = False) -> Arm:
    """A chain or tree of 2 to 7 joints of all types, some held, anyhow placed, under tilted gravity.

    `dressed`: with drives, effects and now and then a fluid; otherwise now and then with a symbol.
    """
    rng = np.random.default_rng(seed)
    while True:
        joints = [_random_joint(rng, i) for i in range(int(rng.integers(2, 8)))]
        if sum(j.type != "fixed" and j.locked is None for j in joints) >= 2:
            break
    if rng.random() < 0.3:
        joints = _shuffled(joints, rng)
    gravity = rng.normal(size=3)
    gravity *= 9.81 / np.linalg.norm(gravity)
    if rng.random() < 0.3:
        gravity = np.array([0, 0, -9.81])
    symbols: dict[str, float] = {}
    density = 0.0
    if dressed:
        for i, joint in enumerate(joints):
            if joint.type != "fixed" and joint.locked is None:
                drive = _random_drive(joint, rng)
                joints[i] = replace(joint, drive=drive, effects=_random_effects(drive, rng))
        density = 1000.0 if rng.random() < 0.3 else 0.0
    elif rng.random() < 0.4:
        i = int(rng.integers(len(joints)))
        symbols = {"length": float(rng.uniform(0.2, 0.5)), "angle": float(rng.uniform(0.3, 1.0))}
        joints[i] = replace(joints[i], d=geometry_symbol("length"), r=2 * geometry_symbol("length"))
        joints[-1] = replace(joints[-1], theta=geometry_symbol("angle"))
    return Arm(
        f"random{seed}",
        tuple(joints),
        (None,) * len(joints),
        (float(gravity[0]), float(gravity[1]), float(gravity[2])),
        density,
        symbols=symbols,
    )


@cache
def generated(seed: int, dressed: bool = False) -> Emitted:
    """A random arm, built once a worker."""
    return build(random_arm(seed, dressed), Options(derivatives=False))


def _param(arm: str, make: Callable[[], Emitted], variant: str = "") -> Any:
    return pytest.param(make, id=arm + variant, marks=pytest.mark.xdist_group(arm))


# Each is called for an `Emitted`; one worker deals with an arm, so that its model is built once.
SHIPPED = [_param(name, lambda name=name: shipped(name)) for name in ARMS]
SHIPPED_LINKS = [_param(name, lambda name=name: shipped(name, "links"), "-links") for name in ARMS]
# The first two dozen, and some whose wrist carries a joint that slides.
SEEDS = [*range(24), 32, 62, 81]
RANDOM_LINKS = [_param(f"random{seed}", lambda seed=seed: generated(seed)) for seed in SEEDS]
DRESSED_SEEDS = range(24)
RANDOM = [_param(f"dressed{seed}", lambda seed=seed: generated(seed, True)) for seed in DRESSED_SEEDS]
