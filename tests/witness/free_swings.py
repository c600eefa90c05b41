"""A swinging link with a spring and stiction, integrated by itself: steps with exact sticking.

J ddq = -G sin q - k (q - q1) - (Fc + Fs exp(-|dq| / vs)) sign(dq) - Fv dq; below static friction it rests.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import copysign, exp, sin

import numpy as np
from numpy.typing import NDArray

STEP = 2e-4  # s
RATE = 1000  # Hz
HELD = 0.3  # s, before the release


@dataclass(frozen=True)
class Link:
    """SI units. excess: of static over Coulomb friction, falling with the exponential of |dq| / velocity."""

    inertia: float
    moment: float
    viscous: float
    coulomb: float
    stiffness: float = 0.0
    rest: float = 0.0
    excess: float = 0.0
    velocity: float = 1.0

    def swing(
        self, start: float, seed: int, *, length: float = 6.0, noise: float = 2e-4, count: float = 0.0
    ) -> NDArray[np.float64]:
        """Times and angles (N, 2) after a release from `start` [rad], noisy, or in steps of `count` [rad]."""
        q, v, stuck, found = start, 0.0, False, []
        every = round(1 / RATE / STEP)
        for i in range(round(length / STEP)):
            if i % every == 0:
                found.append(q)
            if i * STEP < HELD:
                continue
            load = -self.moment * sin(q) - self.stiffness * (q - self.rest)
            holds = abs(load) <= self.coulomb + self.excess
            if stuck and holds:
                continue
            stuck = False
            friction = copysign(self.coulomb + self.excess * exp(-abs(v) / self.velocity), v or load)
            after = v + STEP * (load - friction - self.viscous * v) / self.inertia
            if v and after * v <= 0.0:
                stuck, after = holds, 0.0 if holds else copysign(1e-9, load)
            q, v = q + STEP * (v + after) / 2, after
        angles = np.array(found) + noise * np.random.default_rng(seed).standard_normal(len(found))
        if count:
            angles = count * np.round(np.array(found) / count)
        return np.column_stack([np.arange(len(angles)) / RATE, angles])
