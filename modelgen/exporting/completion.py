"""Bodies for base parameters: standard parameters that could exist and give them, or come nearest.

The cost is that of `identification.nearest`, here with next to no weight of the description's bodies.
"""

from __future__ import annotations

import numpy as np

from modelgen.functions import Model
from modelgen.functions.nominal import base_matrix
from modelgen.identification.bodies import plain, prior_inertia, violations
from modelgen.identification.nearest import Nearest
from modelgen.numeric import Array

WEIGHTS = 10.0 ** np.arange(0, 13)  # of squared relative errors beside the divergence, one after the other
LEAST = 1e-3  # of what the bodies of the description have, to which an error of less is referred
SAME = 1e-9  # relative error of a base parameter that is arithmetic


def completed(model: Model, theta: Array) -> tuple[Array, Array]:
    """Standard parameters (s,) of bodies that could exist, and the relative errors (p,) of the base
    parameters that they give: zero where those are theta.
    """
    grouping = base_matrix(model)
    near = plain(model, theta)
    size = np.maximum(np.abs(theta), LEAST * np.abs(grouping) @ _sizes(model, near))
    size = np.where(size > 0, size, 1.0)
    problem = Nearest(model, grouping / size[:, None], theta / size, near)
    found = _exact(problem, model, near)
    if found is None:
        nearest = problem.along(WEIGHTS.tolist())
        found = _exact(problem, model, nearest)
        if found is None:
            return nearest, (grouping @ nearest - theta) / size
    return found, np.zeros(len(theta))


def _exact(problem: Nearest, model: Model, near: Array) -> Array | None:
    """What gives the target next to `near`, None where it could not exist."""
    scale = np.maximum(np.abs(near), 1e-9 * np.abs(near).max())
    change, *_ = np.linalg.lstsq(problem.matrix * scale, problem.target - problem.matrix @ near, rcond=None)
    found = near + scale * change
    others = found[10 * problem.links :]
    # a friction of zero may come out as less than that by rounding
    others[:] = np.where(np.abs(others - problem.low) <= SAME * problem.typical, problem.low, others)
    inside = bool(np.all((others >= problem.low) & (others <= problem.high)))
    close = bool(np.abs(problem.matrix @ found - problem.target).max(initial=0.0) <= SAME)
    return found if inside and close and not violations(model, found) else None


def _sizes(model: Model, near: Array) -> Array:
    """Size (s,) of each standard parameter: of links those of the description's bodies."""
    count = len(model.arm.links)
    found = []
    for i in range(count):
        inertia = prior_inertia(model, i)
        second, mass = float(np.trace(inertia[:3, :3])), float(inertia[3, 3])
        found += [second] * 6 + [np.sqrt(second * mass)] * 3 + [mass]
    return np.concatenate([found, np.abs(near[10 * count :])])
