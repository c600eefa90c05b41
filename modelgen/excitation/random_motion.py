"""Random trajectories within the limits: starts of the optimiser, and what it is compared with."""

from __future__ import annotations

import numpy as np

from modelgen.errors import InputError
from modelgen.excitation.problem import Problem
from modelgen.numeric import Array

_DRAWS = 200
_HALVINGS = 12
_LEAST = 1e-2  # of the drawn amplitude: what is smaller excites nothing


def feasible(problem: Problem, rng: np.random.Generator, margin: float = 0.0) -> Array:
    """Coefficients z (n, size) of a random trajectory that keeps all limits less `margin` of each.

    Middle and harmonics are drawn, then all harmonics are reduced by one factor until the limits hold.
    Raises InputError where no draw keeps them at all.
    """
    t = problem.grid()
    n, size = len(problem.middle), problem.basis.size
    for _ in range(_DRAWS):
        z = rng.normal(size=(n, size))
        z[:, 0] = rng.uniform(-0.5, 0.5, n) * problem.half / problem.amplitude
        largest = np.abs(problem.basis.signals(t)[0][:, 1:] @ z[:, 1:].T).max(axis=0)
        room = problem.half / problem.amplitude - np.abs(z[:, 0])
        z[:, 1:] *= (room / largest)[:, None]
        found = shrunk(problem, z, t, 1 - margin)
        if found is not None:
            return found
    names = ", ".join(dict.fromkeys(problem.constraints))
    raise InputError(
        f"found no motion within the limits ({names}); the limits or the boxes exclude each other"
    )


def shrunk(problem: Problem, z: Array, t: Array, most: float) -> Array | None:
    """z with its harmonics reduced by the largest factor that keeps every constraint below `most`.

    None where that factor is below a hundredth.
    """

    def scaled(factor: float) -> Array:
        result = z.copy()
        result[:, 1:] *= factor
        return result

    if problem.observation(z, t)[1] <= most:
        return z
    low, high = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        if problem.observation(scaled(middle), t)[1] <= most:
            low = middle
        else:
            high = middle
    return scaled(low) if low >= _LEAST else None
