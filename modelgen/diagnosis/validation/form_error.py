"""What the form of causes that were taken may leave for others: no law is that of the arm to the last."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.diagnosis.candidates.candidate import COMPLIANT, WARMING
from modelgen.diagnosis.candidates.fitted import FittedCandidate
from modelgen.diagnosis.equations.rows import Rows
from modelgen.diagnosis.evidence.system import System, mean_squares
from modelgen.numeric import Array
from modelgen.regression.weighted import rmse, weighted_fit

FORM = 0.05  # of the power that causes explain at a joint: less is what a law's form leaves
SWINGS = 0.1  # the same of elastic joints and play, simulated beside an arm that had taken over some of it
FRICTION = (
    "presliding",
    "stribeck_friction",
    "nonlinear_viscous_friction",
    "load_dependent_friction",
    "position_dependent_friction",
    WARMING,
    "time_delay",  # looks like what sticking does at reversals
)
# What these do follows from the arm's own equations or is a constant: their form leaves nothing to others.
EXACT = (
    "friction_offset",
    "lever_geometry",
    "payload_change",
    "base_tilt",
    "drive_gain_error",
    "encoder_offset",
)
SPRING = ("spring",)  # none is linear over all its travel
FLUID = ("added_mass", "fluid_drag")  # one value for all links, whose widths differ


def with_causes(rows: Sequence[Rows], trials: Sequence[FittedCandidate]) -> list[Array]:
    """Baseline and the causes' columns side by side, by record."""
    return [np.concatenate([r.columns, *(t.columns[i] for t in trials)], axis=2) for i, r in enumerate(rows)]


class Forms:
    """Of the causes taken before, in this order, whose columns stand in the system beside the baseline's."""

    def __init__(self, rows: Sequence[Rows], before: Sequence[FittedCandidate], system: System) -> None:
        self.rows = rows
        self.before = before
        self.system = system
        self._left: dict[tuple[str, ...], Array] = {}

    def least(self, effect: str) -> Array:
        """Percent of the RMSE (n,) that a cause of this effect must exceed at each joint.

        Friction beside friction at its joint; anything beside what a fluid does; and all but FRICTION beside
        a spring at its joint, which is a force over the position, and at any joint beside what swings at one,
        which shakes all links.
        """
        found = self._of(FLUID, FORM)
        if effect in FRICTION:
            return np.maximum(found, self._of(FRICTION, FORM))
        return np.maximum(found, np.maximum(self._of(SPRING, FORM), self._of(COMPLIANT, SWINGS)))

    def _of(self, effects: tuple[str, ...], form: float) -> Array:
        if effects not in self._left:
            there = [t for t in self.before if t.candidate.effect in effects]
            share = np.zeros(self.system.n)
            if there:
                rest = [t for t in self.before if t.candidate.effect not in effects]
                others = with_causes(self.rows, rest)
                left = mean_squares(self.system)
                explained = rmse(self.rows, others, weighted_fit(self.rows, others)) ** 2 - left
                places = [None if effects == COMPLIANT else t.candidate.joint for t in there]
                at = np.array([None in places or j + 1 in places for j in range(self.system.n)])
                share = np.where(at, np.clip(form * explained / np.maximum(left, 1e-300), 0.0, 1.0), 0.0)
            self._left[effects] = np.asarray(100.0 * (1.0 - np.sqrt(1.0 - share)))
        return self._left[effects]
