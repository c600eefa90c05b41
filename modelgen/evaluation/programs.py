"""Functions that only probing needs: inputs, loads, columns and states of one effect."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from modelgen.backends.numpy import NumpyFunction
from modelgen.base_parameters import Grouping, group
from modelgen.base_parameters.rules import slid
from modelgen.description.objects import Arm
from modelgen.effects import described
from modelgen.evaluation.motion import Motion, given_for
from modelgen.functions.bare import bare
from modelgen.functions.dynamics import Dynamics
from modelgen.functions.nominal import factor_value
from modelgen.functions.objects import Argument, Function, Output
from modelgen.functions.parametric import base_values, drives_apart
from modelgen.graph import Expr, cut, lower
from modelgen.model.effect_forces import EffectForces
from modelgen.model.equations import Equations
from modelgen.model.motion import Rates
from modelgen.numeric import Array


def grouping(arm: Arm) -> Grouping:
    """The base parameters of the arm as `build_model` has them."""
    return group(Equations(described(arm)))


def inputs_of(e: Equations, base: Grouping) -> Function:
    """Program of an arm's inputs for another description's base parameters: {q, dq, ddq, parameters}."""
    values = base_values(e, base)
    dynamics = Dynamics(e, values)
    return bare("inputs", e, len(base.base), dynamics.inverse_dynamics(e.vector("dq"), e.vector("ddq")))


def loads_of(e: Equations, base: Grouping) -> Function:
    """Loads at the motor coordinates."""
    return bare("loads", e, len(base.base), Dynamics(e, base_values(e, base)).loads())


def at_motors(e: Equations, base: Grouping) -> Function:
    """Inputs that the effects at the motors add, with the base parameters of `e`'s own arm."""
    values = base_values(e, base, apart=e.arm.coordinates)
    forces = EffectForces(e, Rates(e.vector("dq"), e.vector("ddq")), values)
    return bare("at_motors", e, len(base.base), forces.at_motors())


def columns_of(e: Equations) -> tuple[Function, list[tuple[str, int]]]:
    """Columns of the only effect of `e`: a function, and what its outputs are: (parameter, coordinate)."""
    columns = EffectForces(e, Rates(e.vector("dq"), e.vector("ddq"))).columns()
    names = [parameter.name for effect in e.effects for parameter, _ in effect.parameters]
    entries = [(name, n, x) for name, column in zip(names, columns, strict=True) for n, x in column.items()]
    function = bare("columns", e, 0, [x for _, _, x in entries])
    return function, [(name, n) for name, n, _ in entries]


def steps_of(e: Equations, base: Grouping) -> tuple[Function, Function]:
    """States after dt: what needs neither state nor free values, and from {state, head, free} the rest."""
    forces = EffectForces(e, Rates(e.vector("dq"), e.vector("ddq")), _values(e, base))
    heads, tails = cut(forces.steps(e.graph.input("dt", 0)), ["state", "free"], "head")
    sizes = {"state": len(tails), "head": len(heads), "free": len(e.free)}
    arguments = tuple(Argument(a, size, "", "", float("inf")) for a, size in sizes.items())
    output = Output("out", len(tails), 1, "", "")
    rest = Function("step", "", arguments, (output,), lower({"out": tails}), {})
    found = bare("heads", e, len(base.base), heads)
    return replace(found, arguments=tuple(a for a in found.arguments if a.name not in sizes)), rest


def links_and_effect(e: Equations, base: Grouping) -> Function:
    """Inputs of the links with the only effect of `e`, which has no linear parameters."""
    dynamics = Dynamics(e, _values(e, base))
    return bare("added", e, len(base.base), dynamics.inverse_dynamics(e.vector("dq"), e.vector("ddq")))


def _values(e: Equations, base: Grouping) -> list[Expr]:
    """Link parameters of the base; effects' parameters are none of the base's."""
    values = [e.graph.zero] * len(e.standard)
    links = e.per_link * len(e.arm.joints)
    for k, parameter in enumerate(base.base):
        if parameter.representative < links:
            values[parameter.representative] = e.graph.input("parameters", k)
    return drives_apart(e, base, values)


def links_alone(
    arm: Arm, base: Grouping, joint: int | None, parameters: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The parameters (p,) without the nominal inertia of the drive at coordinate `joint` (from 1) that those
    of links contain.
    """
    alone = np.asarray(parameters, dtype=float).copy()
    index = None if joint is None else arm.coordinates[joint - 1]
    for drive in base.drives:
        if drive.joint == index and drive.nominal is not None:
            alone[drive.base] -= drive.nominal * factor_value(drive.factor, arm.symbols)
    return alone


class Links:
    """Inputs of one arm's links. base: the grouping of its base parameters (p,)."""

    def __init__(self, arm: Arm, base: Grouping) -> None:
        self._arm, self._base = arm, base

    def __call__(self, motion: Motion, parameters: Array) -> Array:
        """Inputs (N, n)."""
        return np.asarray(self._inputs(**given_for(self._inputs.function, motion, parameters)))

    @cached_property
    def _inputs(self) -> NumpyFunction:
        alone = described(self._arm).without_effects()
        return NumpyFunction(links_and_effect(Equations(slid(alone), lazy=True), self._base))
