"""Periodic Fourier trajectories that reach the stated limits (Swevers et al. 1997)."""

import numpy as np
from numpy.random import Generator

from hidden import native
from hidden.arms import Arm
from hidden.native import Array, Plant

HARMONICS = 5
DRAWS = 40


def draw(arm: Arm, random: Generator) -> Plant:
    """A copy of the arm's plant with the best conditioned of some random trajectories."""
    best, least = arm.plant, np.inf
    for _ in range(DRAWS):
        plant = _one(arm, random)
        number = _condition(plant)
        if number < least:
            best, least = plant, number
    return best


def carry_over(source: Plant, target: Plant) -> Plant:
    """A copy of `target` that follows the trajectory of `source`."""
    moved = target.copy()
    for field in ("centre", "sine", "cosine", "frequency", "q0", "dq0", "free"):
        moved[field] = source[field]
    return moved


def motion(plant: Plant, t: Array) -> tuple[Array, Array, Array]:
    """Reference position, speed and acceleration (N, n) of all joints at times t (N,) [s]."""
    n = int(plant["n"])
    w = 2 * np.pi * float(plant["frequency"]) * np.arange(1, HARMONICS + 1)
    sine, cosine = plant["sine"][:n], plant["cosine"][:n]
    s, c = np.sin(np.outer(t, w)), np.cos(np.outer(t, w))
    q = plant["centre"][:n] + s @ sine.T + c @ cosine.T
    dq = (c * w) @ sine.T - (s * w) @ cosine.T
    return q, dq, -(s * w**2) @ sine.T - (c * w**2) @ cosine.T


def _one(arm: Arm, random: Generator) -> Plant:
    plant = arm.plant.copy()
    t = np.linspace(0.0, 1.0 / float(plant["frequency"]), 400, endpoint=False)
    decay = np.arange(1, HARMONICS + 1) ** -0.5
    plant["sine"][: arm.n] = random.normal(size=(arm.n, HARMONICS)) * decay
    plant["cosine"][: arm.n] = random.normal(size=(arm.n, HARMONICS)) * decay
    plant["centre"] = 0.0
    q, dq, ddq = motion(plant, t)
    for j in range(arm.n):
        low, high = arm.position[j]
        span = 0.94 * (high - low) / (q[:, j].max() - q[:, j].min())
        fast = 0.97 * arm.velocity[j] / np.abs(dq[:, j]).max()
        hard = 0.97 * arm.acceleration[j] / np.abs(ddq[:, j]).max()
        scale = min(span, fast, hard)
        plant["sine"][j] *= scale
        plant["cosine"][j] *= scale
        reach = scale * np.array([q[:, j].min(), q[:, j].max()])
        room = (low + 0.02 * (high - low) - reach[0], high - 0.02 * (high - low) - reach[1])
        plant["centre"][j] = random.uniform(*room) if room[1] > room[0] else 0.5 * sum(room)
    return plant


def _condition(plant: Plant) -> float:
    t = np.linspace(0.0, 1.0 / float(plant["frequency"]), 60, endpoint=False)
    stacked = native.regressor(plant, *motion(plant, t)).reshape(-1, 13 * int(plant["n"]))
    size = np.linalg.norm(stacked, axis=0)
    values = np.linalg.svd(stacked[:, size > 0] / size[size > 0], compute_uv=False)
    kept = values[values > 1e-8 * values[0]]
    return float(kept[0] / kept[-1])
