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
from modelgen.evaluation.cache import Recent
from modelgen.evaluation.motion import Motion, given_for
from modelgen.functions.bare import bare
from modelgen.functions.dynamics import Dynamics
from modelgen.functions.nominal import about_origin, factor_value, natural_scale
from modelgen.model.equations import Equations
from modelgen.numeric import Array

NOTHING = 1e-12  # of the largest parameter
WEIGHT = slice(6, 10)  # of a link's standard parameters: first moments, mass
REMEMBERED = 40  # columns that do not depend on how far the base leans


class HiddenWeight:
    """Hidden weight of one arm. base: the grouping whose parameters are known from records."""

    def __init__(self, arm: Arm, base: Grouping) -> None:
        self.arm, self._base = described(arm), base
        self._recent: Recent[Array] = Recent(REMEMBERED)

    @cached_property
    def known(self) -> bool:
        """Whether the description tells it: nominal inertials of every link, and of what floats none does."""
        return not self.arm.fluid_density and all(link is not None for link in self.arm.links)

    def inputs(self, motion: Motion, gravity: Array) -> Array:
        """Inputs (N, n) that hold it in a further gravity (3,) [m/s^2]; zero where it is not known."""
        if not self.known:
            return np.zeros(motion.q.shape)
        drawn = np.zeros(len(self._hidden))
        for i, link in enumerate(self.arm.links):
            assert link is not None
            drawn[self._of_link(i)] = list(about_origin(link).values())
        return np.asarray(self._columns(motion, gravity, [drawn])[:, :, 0])

    def by_scale(self, motion: Motion, gravity: Array) -> Array:
        """What the natural scale of every link's nominal first moments and mass adds, (N, n, h); a unit of
        each where it is not known.
        """
        scales = []
        for i, link in enumerate(self.arm.links):
            mass, first = natural_scale(link) if link is not None and self.known else (1.0, 1.0)
            for k, size in enumerate((first, first, first, mass)):
                scales.append(np.zeros(len(self._hidden)))
                scales[-1][self._of_link(i).start + WEIGHT.start + k] = size
        return self._columns(motion, gravity, scales)

    def _columns(self, motion: Motion, gravity: Array, drawn: list[Array]) -> Array:
        """Inputs (N, n, k) that hold in a further gravity what is hidden of k standard parameters (s,)."""
        found = np.zeros((*motion.q.shape, len(drawn)))
        for k, values in enumerate(drawn):
            hidden = self._hidden @ values
            hidden[np.abs(hidden) <= NOTHING * np.abs(hidden).max(initial=0.0)] = 0.0
            for axis in np.flatnonzero(gravity) if hidden.any() else ():
                found[:, :, k] += gravity[axis] * self._along(int(axis), motion, hidden)
        return found

    def _along(self, axis: int, motion: Motion, hidden: Array) -> Array:
        """Inputs (N, n) that hold hidden parameters (s,) in a gravity of 1 m/s^2 along an axis."""
        given = hidden[self._weighing]

        def made() -> Array:
            call = self._calls[axis]
            return np.asarray(call(**given_for(call.function, motion, given)))

        return self._recent.along(axis, motion, given, made)

    @cached_property
    def _calls(self) -> list[NumpyFunction]:
        return [self._weight(axis) for axis in np.eye(3)]

    def _weight(self, axis: Array) -> NumpyFunction:
        x, y, z = (float(a) for a in axis)
        e = Equations(slid(replace(self.arm.without_effects(), gravity=(x, y, z))), lazy=True)
        values = [e.graph.zero] * len(e.standard)
        for k, place in enumerate(self._weighing):
            values[place] = e.graph.input("parameters", k)
        efforts = Dynamics(e, values).inverse_dynamics(e.zeros(), e.zeros())
        return NumpyFunction(bare("weight", e, len(self._weighing), efforts))

    @cached_property
    def _per_link(self) -> int:
        return Equations(slid(self.arm.without_effects()), lazy=True).per_link

    def _of_link(self, i: int) -> slice:
        """Places of the standard parameters of link i (from 0), volumes aside."""
        return slice(self._per_link * i, self._per_link * i + 10)

    @cached_property
    def _weighing(self) -> list[int]:
        """Places of first moments and masses among the standard parameters."""
        every = range(self._per_link * len(self.arm.joints))
        return [place for i in range(len(self.arm.joints)) for place in every[self._of_link(i)][WEIGHT]]

    @cached_property
    def _hidden(self) -> Array:
        """Standard parameters of the links in the frames of `slid`, of those as drawn, less what the base
        parameters hold of them in the places of their representatives: (s, s), right for first moments and
        masses.
        """
        arm, count = self.arm, self._per_link * len(self.arm.joints)
        moved = np.eye(count)
        for i, joint in enumerate(slid(arm).joints):
            first, last = self._per_link * i + 8, self._per_link * i + 9
            moved[first, last] = factor_value(joint.lift, arm.symbols)
        for parameter in self._base.base:
            if parameter.representative < count:
                for k, factor in parameter.terms:
                    if k < count:
                        moved[parameter.representative, k] -= factor_value(factor, arm.symbols)
        return moved
