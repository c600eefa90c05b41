"""The form of chosen causes leaves something for others: no law is that of the arm to the last."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.diagnosis.candidates import Candidate, FittedCandidate, with_causes
from modelgen.diagnosis.evidence import System, mean_squares
from modelgen.effects import Family
from modelgen.numeric import Array
from modelgen.regression.weighted import rmse, weighted_fit


class Forms:
    """Form errors of the causes chosen before, whose columns are in the system beside the baseline's."""

    def __init__(self, before: Sequence[FittedCandidate], system: System) -> None:
        self.before = before
        self.system = system
        self._left: dict[Family, Array] = {}

    def least(self, candidate: Candidate) -> Array:
        """Percent of the RMSE (n,) that a cause must exceed at each joint.

        Friction beside friction at its joint; anything beside what a fluid does; and all but friction beside
        a spring at its joint, which is a force over the position, and at any joint beside what swings at one,
        which shakes all links.
        """
        found = self._of(Family.FLUID)
        if candidate.definition.family is Family.FRICTION:
            return np.maximum(found, self._of(Family.FRICTION))
        return np.maximum(found, np.maximum(self._of(Family.SPRING), self._of(Family.ELASTIC)))

    def _of(self, family: Family) -> Array:
        if family not in self._left:
            there = [t for t in self.before if t.candidate.definition.family is family]
            share = np.zeros(self.system.n)
            if there:
                rest = [t for t in self.before if t.candidate.definition.family is not family]
                rows, others = self.system.rows, with_causes(self.system.equations, rest)
                left = mean_squares(self.system)
                explained = rmse(rows, others, weighted_fit(rows, others)) ** 2 - left
                elastic = family is Family.ELASTIC
                places = [None if elastic else t.candidate.joint for t in there]
                at = np.array([None in places or j + 1 in places for j in range(self.system.n)])
                limits = self.system.equations.thresholds.validation
                form = limits.elastic_form_error if elastic else limits.form_error
                share = np.where(at, np.clip(form * explained / np.maximum(left, 1e-300), 0.0, 1.0), 0.0)
            self._left[family] = np.asarray(100.0 * (1.0 - np.sqrt(1.0 - share)))
        return self._left[family]
