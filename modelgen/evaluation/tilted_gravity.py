"""Weight of links that an upright arm hides, and that shows once gravity is turned.

No record of an arm whose first axis is vertical tells the first moments of its first link, nor any mass that
the grouping gives to others; a base that leans makes them weigh on the first joint. The base parameters
do not contain them; the description's nominal inertials do, where all links have some.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np

from modelgen.backends.numpy import NumpyFunction
from modelgen.base_parameters import Grouping
from modelgen.base_parameters.rules import slid
from modelgen.description.objects import Arm
from modelgen.effects import described
from modelgen.evaluation.motion import Motion, given_for
from modelgen.functions.bare import bare
from modelgen.functions.dynamics import Dynamics
from modelgen.functions.nominal import about_origin, factor_value
from modelgen.model.equations import Equations
from modelgen.numeric import Array

NOTHING = 1e-12  # of the largest parameter


class HiddenWeight:
    """Hidden weight of one arm. base: the grouping whose parameters are known from records."""

    def __init__(self, arm: Arm, base: Grouping) -> None:
        self.arm = described(arm)
        self._values = _hidden(self.arm, base)

    def columns(self, motion: Motion) -> Array:
        """Inputs (3, N, n) that hold it in a gravity of 1 m/s^2 along each axis of the base."""
        if self._values is None:
            return np.zeros((3, *motion.q.shape))
        return np.array([call(**given_for(call.function, motion, np.zeros(0))) for call in self._calls])

    @cached_property
    def _calls(self) -> list[NumpyFunction]:
        return [self._along(axis) for axis in np.eye(3)]

    def _along(self, axis: Array) -> NumpyFunction:
        assert self._values is not None
        x, y, z = (float(a) for a in axis)
        e = Equations(slid(replace(self.arm.without_effects(), gravity=(x, y, z))), lazy=True)
        values = [e.graph.const(v) for v in self._values]
        return NumpyFunction(bare("weight", e, 0, Dynamics(e, values).inverse_dynamics(e.zeros(), e.zeros())))


def _hidden(arm: Arm, base: Grouping) -> Array | None:
    """Nominal standard parameters of the links, in the frames of `slid`, less what the base parameters hold
    of them in the places of their representatives; None where a link has no nominal inertials, and in a
    fluid: a description has no volumes, and what floats weighs nothing.
    """
    if arm.fluid_density:
        return None
    count = 10 * len(arm.joints)
    drawn, moved = np.zeros(count), np.zeros(count)
    for i, (link, joint) in enumerate(zip(arm.links, slid(arm).joints, strict=True)):
        if link is None:
            return None
        x, y, z = link.com
        lift = factor_value(joint.lift, arm.symbols)
        for values, place in ((drawn, link), (moved, replace(link, com=(x, y, z + lift)))):
            values[10 * i : 10 * i + 10] = list(about_origin(place).values())
    for parameter in base.base:
        terms = [(k, f) for k, f in parameter.terms if k < count]
        if parameter.representative < count:
            held = sum(drawn[k] * factor_value(f, arm.symbols) for k, f in terms)
            moved[parameter.representative] -= held
    return np.where(np.abs(moved) > NOTHING * np.abs(moved).max(initial=0.0), moved, 0.0)
