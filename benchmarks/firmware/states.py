"""Inputs for the functions of an arm: states within the levers' strokes, parameters of possible bodies."""

from __future__ import annotations

from math import pi

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from modelgen.functions import Function, Model
from modelgen.transmission import STROKE_MARGIN

Array = NDArray[np.float64]

_MASS, _INERTIA = 2.0, 0.1  # of every link [kg], [kg m^2] about its centre of mass
_COM = np.array([0.1, 0.05, -0.05])  # m
_COEFFICIENT = 0.01  # of friction and the like; drives have no inertia
_SPREAD = {"q": pi, "dq": 2.0, "ddq": 3.0, "dq_r": 2.0, "ddq_r": 3.0, "input": 1.0}

_STEP = {"dt": 1e-3, "gain": 30.0, "forgetting": 0.99}  # of the functions that watch an arm


def standard_parameters(model: Model) -> Array:
    """The same ball for every link, in the order of the model's standard parameters."""
    tensor = _INERTIA * np.eye(3) + _MASS * (_COM @ _COM * np.eye(3) - np.outer(_COM, _COM))
    ball = dict(zip(("XX", "XY", "XZ", "YY", "YZ", "ZZ"), tensor[np.triu_indices(3)], strict=True))
    ball |= dict(zip(("MX", "MY", "MZ"), _MASS * _COM, strict=True))
    values = {f"{name}{i + 1}": value for name, value in ball.items() for i in range(len(model.arm.joints))}
    values |= {f"M{i + 1}": _MASS for i in range(len(model.arm.joints))}
    values |= {p.name: 0.0 for p in model.standard if p.name.startswith(("IA", "V"))}
    return np.array([values.get(p.name, _COEFFICIENT) for p in model.standard])


def base_of(model: Model, standard: Array) -> Array:
    """The base parameters of a vector of standard parameters."""
    return np.array(
        [
            sum(standard[i] * _number(factor, model) for i, factor in parameter.terms)
            for parameter in model.grouping.base
        ]
    )


class Inputs:
    """Random inputs of a model's functions, always the same for the same seed."""

    def __init__(self, model: Model, seed: int) -> None:
        self.model = model
        self.rng = np.random.default_rng(seed)
        self.standard = standard_parameters(model)
        self.base = base_of(model, self.standard)

    def __call__(self, function: Function, *, ends: bool = False) -> list[Array]:
        """A sample of every input. `ends`: each lever at one end of its stroke or the other."""
        rng, result = self.rng, []
        q = rng.uniform(-pi, pi, len(self.model.arm.coordinates))
        for r in function.ranges:
            if r.argument == "q":
                low, high = r.low + STROKE_MARGIN, r.high - STROKE_MARGIN
                q[r.index] = rng.choice([low, high]) if ends else rng.uniform(low, high)
        for a in function.arguments:
            value = rng.uniform(-1.0, 1.0, a.size) * _SPREAD.get(a.name, 1.0)
            if a.name == "q":
                value = q
            elif a.name == "parameters":
                value = self.standard if function.name.endswith("_standard") else self.base
            elif a.name in _STEP:
                value = np.full(a.size, _STEP[a.name])
            elif a.length == "N_MONITOR_STATES":
                value = monitor_state(a.size, rng)
            elif a.name == "q_m":
                for r in function.ranges:
                    inner = (r.high - r.low) / 1.002  # the range without its margin of a thousandth
                    ratio = rng.choice([-0.5, 0.5]) if ends else rng.uniform(-0.5, 0.5)
                    value[r.index] = (r.low + r.high) / 2 + ratio * inner
            result.append(value)
        return result


def monitor_state(size: int, rng: np.random.Generator) -> Array:
    """What a monitor may have accumulated of m parameters in 8 m steps: 3 m elements, then half of a matrix.

    Of as few steps as there are parameters the matrix may be near a singular one, and single precision solves
    with it to as much less.
    """
    m = next(m for m in range(size) if 3 * m + m * (m + 1) // 2 == size)
    root = rng.uniform(-1, 1, (8 * m, m))
    return np.concatenate([rng.uniform(-1, 1, 3 * m), (root.T @ root)[np.tril_indices(m)]])


def _number(factor: float | sp.Expr, model: Model) -> float:
    if isinstance(factor, sp.Expr):
        factor = factor.subs({symbol: model.arm.symbols[str(symbol)] for symbol in factor.free_symbols})
    return float(factor)
