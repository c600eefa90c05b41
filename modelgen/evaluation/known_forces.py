"""Forces that a description knows whole, as a payload's of known mass: no estimated parameter scales them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from modelgen.backends.numpy import NumpyFunction
from modelgen.base_parameters.rules import slid
from modelgen.description import Arm
from modelgen.description.objects import EffectUse
from modelgen.effects import applied_effects, described
from modelgen.evaluation.motion import Motion, evaluated, given_for
from modelgen.functions.bare import bare
from modelgen.functions.dynamics import Dynamics
from modelgen.model.equations import Equations
from modelgen.numeric import Array


class KnownForces:
    """Known forces of one arm."""

    def __init__(self, arm: Arm) -> None:
        self.arm = described(arm)

    @property
    def any(self) -> bool:
        """Whether there are some."""
        return self._call is not None

    def inputs(self, motion: Motion) -> Array:
        """Inputs of ideal drives (N, n) that they take, beside the regressor times the base parameters."""
        if self._call is None:
            return np.zeros(motion.q.shape)
        return evaluated(self._call, given_for(self._call.function, motion, np.zeros(0)), motion)

    @cached_property
    def _call(self) -> NumpyFunction | None:
        known = [e for e in applied_effects(self.arm) if e.constant]
        if not known:
            return None

        def kept(uses: Sequence[EffectUse], joint: int | None) -> tuple[EffectUse, ...]:
            names = {e.effect.name for e in known if e.joint == joint}
            return tuple(use for use in uses if use.name in names)

        joints = tuple(replace(j, effects=kept(j.effects, i)) for i, j in enumerate(self.arm.joints))
        alone = replace(self.arm, joints=joints, effects=kept(self.arm.effects, None), monitor=())
        e = Equations(slid(alone), lazy=True)
        dynamics = Dynamics(e, [e.graph.zero] * len(e.standard))
        inputs = dynamics.inverse_dynamics(e.vector("dq"), e.vector("ddq"))
        return NumpyFunction(bare("known", e, 0, inputs))
