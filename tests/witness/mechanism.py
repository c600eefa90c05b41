"""The whole arm: links by Pinocchio, drives by their geometry, effects written anew."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from modelgen.description import Arm, EffectUse
from witness.bodies import TEN, Body, random_bodies
from witness.geometry import moving
from witness.levers import Drive
from witness.rigid_bodies import RigidBodies

Array = NDArray[np.float64]


def sign(v: Array, values: Mapping[str, float]) -> Array:
    """Direction of motion, smoothed on demand."""
    width = values.get("smoothing", 0.0)
    return np.tanh(v / width) if width else np.sign(v)


def stribeck(v: Array, values: Mapping[str, float]) -> Array:
    """Fall of static friction."""
    return np.exp(-(np.abs(v / values["velocity"]) ** values.get("exponent", 2.0))) * sign(v, values)


# symbol -> column, over position, velocity and acceleration of the effect's coordinate
Laws = dict[str, Callable[[Array, Array, Array, Mapping[str, float]], Any]]
MOTOR_SIDE: dict[str, Laws] = {
    "viscous_friction": {"FV": lambda x, v, a, p: v},
    "coulomb_friction": {"FC": lambda x, v, a, p: sign(v, p)},
    "friction_offset": {"FO": lambda x, v, a, p: np.ones_like(v)},
    "stribeck_friction": {"FS": lambda x, v, a, p: stribeck(v, p)},
    "drive_inertia": {"IA": lambda x, v, a, p: a},
}
JOINT_SIDE: dict[str, Laws] = {
    "spring": {"KS": lambda x, v, a, p: x, "KO": lambda x, v, a, p: np.ones_like(v)},
}


def effect_columns(use: EffectUse, drive: Drive, q: Array, dq: Array, ddq: Array) -> dict[str, Array]:
    """Input per unit of each of an effect's parameters; one entry a sample."""
    if use.name in JOINT_SIDE:
        laws = JOINT_SIDE[use.name]
        return {s: law(q, dq, ddq, use.values) / drive.gain(q) for s, law in laws.items()}
    motor = drive.motor(q), drive.k1(q) * dq, drive.k1(q) * ddq + drive.slope(q) * dq**2
    return {s: law(*motor, use.values) / drive.constant for s, law in MOTOR_SIDE[use.name].items()}


class Mechanism:
    """The regressor of all standard parameters; inputs in amperes or, undriven, efforts."""

    def __init__(self, arm: Arm) -> None:
        self.arm = arm
        rng = np.random.default_rng(7)
        self.links = RigidBodies(arm, random_bodies(arm, rng), every_joint=True)
        self.moving = moving(arm)
        self.drives = [Drive(arm, i) for i in self.moving]
        self.per_link = 14 if arm.fluid_density else 10

    def names(self) -> list[str]:
        """Names of the standard parameters, link after link, then joint after joint."""
        symbols = [*TEN, *(("VX", "VY", "VZ", "V") if self.arm.fluid_density else ())]
        result = [f"{s}{i + 1}" for i in range(len(self.arm.joints)) for s in symbols]
        for i in self.moving:
            for use in self.arm.joints[i].effects:
                laws = {**MOTOR_SIDE, **JOINT_SIDE}[use.name]
                result += [f"{s}{i + 1}" for s in laws]
        return result

    def gains(self, q: Array) -> Array:
        """Joint effort per input, samples x n."""
        return np.stack([drive.gain(q[:, n]) for n, drive in enumerate(self.drives)], axis=1)

    def regressor(self, q: Array, dq: Array, ddq: Array) -> Array:
        """samples x n x standard parameters."""
        samples, n = q.shape
        links = np.stack([self._links(*sample) for sample in zip(q, dq, ddq, strict=True)])
        blocks = [links / self.gains(q)[:, :, None]]
        for k, i in enumerate(self.moving):
            for use in self.arm.joints[i].effects:
                for column in effect_columns(use, self.drives[k], q[:, k], dq[:, k], ddq[:, k]).values():
                    block = np.zeros((samples, n, 1))
                    block[:, k, 0] = column
                    blocks.append(block)
        return np.concatenate(blocks, axis=2)

    def _links(self, q: Array, dq: Array, ddq: Array) -> Array:
        inertial = self.links.regressor(q, dq, ddq)
        if not self.arm.fluid_density:
            return inertial
        blocks = []
        for i in range(len(self.arm.joints)):
            blocks += [inertial[:, 10 * i : 10 * i + 10], self._buoyancy(q, i)]
        return np.hstack(blocks)

    def _buoyancy(self, q: Array, link: int) -> Array:
        """n x 4: efforts that hold a unit first moment of volume, and a unit volume, in place."""
        rotation = self.links.poses(q)[link][:3, :3]
        jacobian = self.links.jacobian(q, link)
        weight = self.arm.fluid_density * np.array(self.arm.gravity)  # of the displaced fluid
        moments = [jacobian[3:].T @ np.cross(rotation[:, k], weight) for k in range(3)]
        return np.stack([*moments, jacobian[:3].T @ weight], axis=1)

    def standard(self, bodies: Sequence[Body], rng: np.random.Generator) -> Array:
        """A standard vector: the bodies' ten each, the rest at random with the drives' scale."""
        values: dict[str, float] = {}
        for i, body in enumerate(bodies):
            values |= {f"{s}{i + 1}": v for s, v in zip(TEN, body.ten, strict=True)}
            volume = rng.uniform(0.5, 1.5) * 1e-3
            values |= {
                f"V{a}{i + 1}": volume * x for a, x in zip("XYZ", rng.uniform(-0.2, 0.2, 3), strict=True)
            }
            values[f"V{i + 1}"] = volume
        for k, i in enumerate(self.moving):
            # what is 1 at the joint, at the motor coordinate
            ratio = abs(self.drives[k].k1(np.mean(self.drives[k].span() or (0.4, 0.4))))
            values[f"IA{i + 1}"] = rng.uniform(0.5, 1.0) / ratio**2
            values[f"FV{i + 1}"] = rng.uniform(0.5, 1.0) / ratio**2
            for s in ("FC", "FO", "FS"):
                values[f"{s}{i + 1}"] = rng.uniform(0.5, 1.0) / ratio
            values[f"KS{i + 1}"], values[f"KO{i + 1}"] = rng.uniform(1, 2), rng.uniform(-1, 1)
        return np.array([values[name] for name in self.names()])


def states(arm: Arm, samples: int, seed: int = 1) -> tuple[Array, Array, Array]:
    """Random q, dq, ddq, samples x n: inside the levers' strokes, otherwise over the whole turn."""
    rng = np.random.default_rng(seed)
    shape = samples, len(moving(arm))
    q = rng.uniform(-3.1, 3.1, shape)
    for k, i in enumerate(moving(arm)):
        span = Drive(arm, i).span()
        if arm.joints[i].type == "prismatic":
            span = -0.5, 0.5
        if span:
            low, high = span
            q[:, k] = rng.uniform(low + 0.02 * (high - low), high - 0.02 * (high - low), samples)
    return q, rng.uniform(-2, 2, shape), rng.uniform(-5, 5, shape)
