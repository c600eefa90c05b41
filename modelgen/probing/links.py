"""Inputs of an arm's links alone, without what acts at its drives."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from modelgen.backends.numpy import NumpyFunction
from modelgen.base_parameters import Grouping
from modelgen.base_parameters.analytic import slid
from modelgen.description.objects import Arm
from modelgen.effects import described
from modelgen.model.equations import Equations
from modelgen.numeric import Array
from modelgen.probing.motion import Motion, given_for
from modelgen.probing.programs import links_and_effect


class Links:
    """Of one arm. base: the grouping that its base parameters (p,) are of."""

    def __init__(self, arm: Arm, base: Grouping) -> None:
        self._arm, self._base = arm, base

    def __call__(self, motion: Motion, parameters: Array) -> Array:
        """Inputs (N, n)."""
        return np.asarray(self._inputs(**given_for(self._inputs.function, motion, parameters)))

    @cached_property
    def _inputs(self) -> NumpyFunction:
        alone = described(self._arm).without_effects()
        return NumpyFunction(links_and_effect(Equations(slid(alone), lazy=True), self._base))
