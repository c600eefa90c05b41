"""The numeric rank of the regressor at random states: what is independent, and of what the rest is made."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from modelgen.graph import Expr
from modelgen.graph.evaluate import evaluate
from modelgen.model.equations import Equations
from modelgen.numeric import Array

SEED = 20180521
DEPENDENT = 1e-9  # part of a column, of unit length, that others leave over when it depends on them


@dataclass(frozen=True)
class Rank:
    """Columns by their place in the list given: kept, and for the others their factors on the kept."""

    kept: tuple[int, ...]
    dependent: dict[int, dict[int, float]]


def random_states(equations: Equations, samples: int, seed: int = SEED) -> dict[str, Array]:
    """Random q, dq, ddq (samples x n) within the levers' strokes and the limits that are no turn."""
    generator = np.random.default_rng(seed)
    n = equations.n
    low, high = np.full(n, -math.pi), np.full(n, math.pi)
    for k, drive in enumerate(equations.drives):
        joint = equations.arm.joints[equations.arm.coordinates[k]]
        span = drive.transmission.joint_range()
        if joint.type == "prismatic":
            span = joint.limits.position or (-1.0, 1.0)
        if span is not None:
            low[k], high[k] = span
    inside = low + (high - low) * (0.02 + 0.96 * generator.random((samples, n)))
    states = {
        "q": inside,
        "dq": _speeds(generator, samples, n),
        "ddq": generator.uniform(-5.0, 5.0, (samples, n)),
        "state": generator.uniform(-1.0, 1.0, (samples, max(1, len(equations.state_names())))),
        "time": generator.uniform(0.0, 60.0, (samples, 1)),
        "load": generator.uniform(-1.0, 1.0, (samples, n)),
        "free": np.ones((samples, max(1, len(equations.free)))),
        "sin_q": np.sin(inside),
        "cos_q": np.cos(inside),
    }
    values = [float(v) for v in equations.arm.symbols.values()]
    states["geometry"] = np.tile(values, (samples, 1)) if values else np.zeros((samples, 1))
    return states


def _speeds(generator: np.random.Generator, samples: int, n: int) -> Array:
    """Up to 2 rad/s or m/s, every other sample slower, joint by joint over five decades.

    What shows only near rest (the Stribeck effect of a slow joint) must be met in some sample.
    """
    speeds = generator.uniform(-2.0, 2.0, (samples, n))
    slower = np.geomspace(1.0, 1e-5, samples // 2)
    speeds[: 2 * len(slower) : 2] *= np.column_stack([generator.permutation(slower) for _ in range(n)])
    return speeds


def regressor_values(columns: Sequence[dict[int, Expr]], equations: Equations, seed: int = SEED) -> Array:
    """The columns at random states, rows stacked: (samples n) x len(columns).

    columns: {coordinate: expression}; a missing coordinate is zero.
    """
    n = equations.n
    rows = {row for column in columns for row in column}
    samples = max(6 * n, 2 * len(columns) // max(1, len(rows)) + 6)
    flat = [e for column in columns for e in column.values()]
    values = evaluate(flat, random_states(equations, samples, seed), samples)
    matrix = np.zeros((samples, n, len(columns)))
    place = 0
    for k, column in enumerate(columns):
        for row in column:
            matrix[:, row, k] = values[:, place]
            place += 1
    return matrix.reshape(samples * n, len(columns))


def rank(matrix: Array, links: int) -> Rank:
    """Keep each column that the ones kept before it do not span; express the others in those kept.

    Columns are scaled to unit length; orthogonalisation is done twice, which keeps it accurate. The
    first `links` columns are those of links: one is zero where it is so beside the largest of them.
    Those of effects come in the units of the motor coordinates, whatever these are.
    """
    norms = np.linalg.norm(matrix, axis=0)
    nothing = np.zeros(matrix.shape[1])
    nothing[:links] = 1e-13 * norms[:links].max(initial=0.0)
    basis = np.zeros((matrix.shape[0], 0))
    kept: list[int] = []
    rest: list[int] = []
    for k in range(matrix.shape[1]):
        if norms[k] <= nothing[k]:
            rest.append(k)
            continue
        column = matrix[:, k] / norms[k]
        for _ in range(2):
            column = column - basis @ (basis.T @ column)
        left = float(np.linalg.norm(column))
        if left > DEPENDENT:
            kept.append(k)
            basis = np.column_stack([basis, column / left])
        else:
            rest.append(k)
    dependent: dict[int, dict[int, float]] = {}
    chosen = matrix[:, kept] / norms[kept]
    for k in rest:
        factors: dict[int, float] = {}
        if norms[k] > nothing[k]:
            solution = np.linalg.lstsq(chosen, matrix[:, k] / norms[k], rcond=None)[0]
            for place, weight in zip(kept, solution, strict=True):
                if abs(weight) > 1e-8:
                    factors[place] = _rounded(float(weight * norms[k] / norms[place]))
        dependent[k] = factors
    return Rank(tuple(kept), dependent)


def _rounded(value: float) -> float:
    """`value` to nine digits where these say it all but for rounding errors."""
    short = float(f"{value:.9g}")
    return short if abs(short - value) <= 1e-11 * abs(value) else value
