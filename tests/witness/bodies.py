"""Random bodies that could exist: clouds of point masses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from modelgen.description import Arm

Vector = NDArray[np.float64]

TEN = ("XX", "XY", "XZ", "YY", "YZ", "ZZ", "MX", "MY", "MZ", "M")


@dataclass(frozen=True)
class Body:
    """Mass [kg], centre of mass [m] and inertia about it [kg m^2], in the link's frame."""

    mass: float
    com: Vector
    inertia: Vector

    @property
    def ten(self) -> Vector:
        """XX, XY, XZ, YY, YZ, ZZ about the frame's origin, first moments, mass."""
        c = self.com
        about_origin = self.inertia + self.mass * (c @ c * np.eye(3) - np.outer(c, c))
        return np.concatenate([about_origin[np.triu_indices(3)], self.mass * c, [self.mass]])


def random_body(rng: np.random.Generator) -> Body:
    """A dozen point masses, off centre."""
    masses = rng.uniform(0.05, 0.8, 12)
    points = rng.uniform(-0.25, 0.25, (12, 3)) + rng.uniform(-0.15, 0.15, 3)
    com = masses @ points / masses.sum()
    inertia = np.zeros((3, 3))
    for m, p in zip(masses, points - com, strict=True):
        inertia += m * (p @ p * np.eye(3) - np.outer(p, p))
    return Body(float(masses.sum()), com, inertia)


def random_bodies(arm: Arm, rng: np.random.Generator) -> list[Body]:
    """One body a link."""
    return [random_body(rng) for _ in arm.joints]
