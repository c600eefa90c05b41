"""Parts of an arm that turn with two joints: wrists whose motors are coupled, belts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modelgen.description import Arm
from modelgen.effects import CATALOGUE
from modelgen.numeric import Array


@dataclass(frozen=True)
class Coupling:
    """one, other: coordinates of the joints, from 0. ratio: turns of the first per turn of the other."""

    one: int
    other: int
    ratio: float

    def speed(self, dq: Array) -> Array:
        """Of the part (N, 1), for speeds of the joints (N, n)."""
        return np.asarray(dq[:, [self.one]] + self.ratio * dq[:, [self.other]])

    def gate(self, gates: tuple[float, ...]) -> float:
        """Speed below which it rests, for those of the joints (n,)."""
        return gates[self.one] + abs(self.ratio) * gates[self.other]


def couplings_of(arm: Arm) -> list[Coupling]:
    """Those of the arm's description."""
    found = []
    for number, i in enumerate(arm.coordinates):
        for used in arm.joints[i].effects:
            pair = CATALOGUE[used.name].coupled(used.values)
            if pair is not None:
                found.append(Coupling(number, pair[0] - 1, pair[1]))
    return found
