"""Deviations of tuned parameters hold what noise of the efforts does to all of the motion that follows it."""

from __future__ import annotations

import numpy as np
import pytest

import modelgen as mg
from modelgen.description import loads
from modelgen.effects import known_effects

ARM = loads(
    """
schema: 1
convention: khalil_kleinfinger
arms:
  one:
    gravity: [0, -9.81, 0]
    joints:
      - {name: hip, drive: {type: direct, ratio: 50, torque_constant: 0.1},
         effects: [{viscous_friction: {coefficient: 4.0e-4}}]}
    links:
      hip: {mass: 4, com: [0.25, 0, 0], inertia: [0.01, 0, 0, 0.2, 0, 0.2]}
""",
    "arms.yaml",
    known_effects(),
)["one"]
# By hand: m c^2 + I, m c; of a drive of 50 to 1 its friction, as the motor has it.
TRUTH = {
    "ZZ1R": 4 * 0.25**2 + 0.2,
    "MX1R": 1.0,
    "ZZ1": 4 * 0.25**2 + 0.2,
    "MX1": 1.0,
    "MY1": 0.0,
    "FV1": 4.0e-4,
}
RATE, SECONDS, WITHIN = 100.0, 6.0, 20  # Hz, s, steps of the plant in a sample
NOISE, COUNTS = 0.05, 5e-5  # A, rad


def acceleration(q: float, dq: float, current: float) -> float:
    """Of a pendulum about a horizontal axis, q from the horizontal."""
    return (5.0 * current - 1.0 * dq - 9.81 * np.cos(q)) / 0.45


def log(seed: int) -> dict[str, np.ndarray]:
    """A swing about the hanging position: each effort is held, and what is read of it is off by noise."""
    random, t = np.random.default_rng(seed), np.arange(int(RATE * SECONDS)) / RATE
    phase = random.uniform(0, 6.28, 4)
    current = 0.9 * np.sin(2 * np.pi * np.outer(t, (0.2, 0.5, 0.9, 1.4)) + phase).sum(axis=1)
    q, dq, h, path = -0.5 * np.pi, 0.0, 1.0 / RATE / WITHIN, []
    for u in current:
        path.append(q)
        for _ in range(WITHIN):
            half = dq + 0.5 * h * acceleration(q, dq, u)
            dq += h * acceleration(q + 0.5 * h * dq, half, u)
            q += h * half
    read = np.array(path) + COUNTS * random.standard_normal(len(t))
    return {"t": t, "q1": read, "i1": current + NOISE * random.standard_normal(len(t))}


@pytest.mark.parametrize("window", [None, 0.75])
def test_deviations_hold_what_noise_of_the_efforts_does(window: float | None) -> None:
    """Over records: errors in deviations have the size of one. That of one effort is in all positions after
    it, so that errors which are no longer than a window do not show how far they hang together.
    """
    found = []
    for seed in range(6):
        result = mg.refine(ARM, log(seed), window=window)
        assert result.converged
        found.append([(x.value - TRUTH[name]) / x.std for name, x in result.parameters.items() if x.std])
    away = np.array(found)
    assert away.shape == (6, 4)
    assert 0.6 < np.sqrt(np.mean(away**2)) < 1.6
    assert np.abs(away).max() < 4.0
