"""Physically consistent parameters: links that could exist, as close to the data and to a prior as can be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modelgen.errors import InputError
from modelgen.functions import Model
from modelgen.functions.nominal import base_matrix
from modelgen.identification.bodies import plain, violations
from modelgen.identification.nearest import Nearest
from modelgen.numeric import Array

PRIOR = 1e-3  # weight of the prior beside the data's chi square, per link


@dataclass(frozen=True)
class Consistent:
    """Standard parameters (s,) that could exist, and the base parameters (p,) that they give.

    distance: chi square per parameter by which the data would rather have others. violated: links to which
    the plain solution closest to the prior gives a negative mass or an impossible inertia, in words.
    """

    standard: Array
    base: Array
    distance: float
    violated: tuple[str, ...]


def consistent(model: Model, theta: Array, precision: Array) -> Consistent:
    """The consistent standard parameters closest to theta (p,) in the metric `precision` (p, p).

    Minimises (K x - theta)' precision (K x - theta) / 2 plus PRIOR times the entropic divergence of each link
    from the description's (Lee, Wensing and Park 2020), K x the base parameters of the standard vector x;
    parameters of effects keep above their bounds. The problem is convex: see `nearest`. Raises InputError for
    an arm in a fluid.
    """
    arm = model.arm
    if arm.fluid_density:
        raise InputError(f"{arm.name}: --consistent knows no buoyancy; expected fluid_density 0")
    grouping, root, near = base_matrix(model), _root(precision), plain(model, theta)
    problem = Nearest(model, root @ grouping, root @ theta, near)
    standard = problem.along(problem.gently(1 / PRIOR))
    base = grouping @ standard
    left = base - theta
    distance = float(left @ precision @ left) / len(theta)
    return Consistent(standard, base, distance, violations(model, near))


def _root(precision: Array) -> Array:
    """R (p, p) with R' R = precision."""
    values, vectors = np.linalg.eigh((precision + precision.T) / 2)
    return np.asarray(np.sqrt(np.maximum(values, 0.0))[:, None] * vectors.T)
