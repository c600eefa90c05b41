"""The bodies that could exist nearest to what is asked for: a convex problem that has one answer.

The cost is a weight times half the squared error of linear functions of the standard parameters, and the
entropic divergence of every link from the description's (Lee, Wensing and Park 2020). It is convex in the
standard parameters and infinite outside of what could exist (mass positive, pseudo-inertia positive definite:
Wensing, Kim and Slotine 2018), so that Newton's method goes from the description's bodies to its minimum,
from small weights to great ones (Boyd and Vandenberghe, Convex Optimization, 2004, chapters 9 and 11).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.linalg import solve_triangular
from scipy.linalg.lapack import dpotrf

from modelgen.effects import applied_effects
from modelgen.functions import Model
from modelgen.identification.bodies import prior_inertia, pseudo_inertia, ten
from modelgen.numeric import Array

STEPS = 200  # of Newton's method for one weight
DONE = 1e-10  # decrease of the cost that ends them
LEAD = 0.1  # share of the decrease promised that a step must bring (Armijo 1966)
SHORTEST = 1e-12  # share of a step below which rounding alone is left
LEAST_TYPICAL = 0.1  # of an effect's typical size, above its bound at the beginning
_BASIS = np.array([pseudo_inertia(row) for row in np.eye(10)])  # (10, 4, 4)


class Nearest:
    """s standard parameters of links and effects, of which matrix (r, s) makes what target (r,) asks for.

    near: standard parameters (s,) that say of what size those of effects are.
    """

    def __init__(self, model: Model, matrix: Array, target: Array, near: Array) -> None:
        self.matrix, self.target = matrix, target
        self.links = len(model.arm.links)
        priors = [prior_inertia(model, i) for i in range(self.links)]
        self.inverses = [np.linalg.inv(prior) for prior in priors]
        bounds = [p.bounds for effect in applied_effects(model.arm) for p, _ in effect.parameters]
        self.low, self.high = (np.array([b[k] for b in bounds], dtype=float) for k in (0, 1))
        others = near[10 * self.links :]
        self.typical = np.where(others != 0, np.abs(others), 1.0)
        self.bounded = np.isfinite(self.low)
        above = np.maximum(others - self.low, LEAST_TYPICAL * self.typical)
        begin = np.where(self.bounded, above + np.where(self.bounded, self.low, 0.0), others)
        self.begin = np.concatenate([*(ten(prior) for prior in priors), begin])

    def along(self, weights: Sequence[float]) -> Array:
        """The minimum (s,) for the last weight, by way of the others."""
        x = self.begin
        for weight in weights:
            x = self.minimum(x, weight)
        return x

    def gently(self, weight: float) -> list[float]:
        """Weights from one at which the divergences rule to this one, tenfold each."""
        typical = np.concatenate([np.abs(self.begin[: 10 * self.links]), self.typical])
        greatest = float(np.linalg.norm(self.matrix * typical, ord=2)) ** 2
        count = max(0, int(np.ceil(np.log10(max(weight * greatest, 1.0)))))
        return [weight * 10.0**-k for k in range(count, -1, -1)]

    def minimum(self, x: Array, weight: float) -> Array:
        """Newton's method with steps that are halved until they are inside and lead down."""
        for _ in range(STEPS):
            cost, slope, root = self._cost(x, weight)
            scale = 1 / np.linalg.norm(root, axis=0)
            upper = np.linalg.qr(root * scale, mode="r")
            step = -scale * solve_triangular(upper, solve_triangular(upper, scale * slope, trans="T"))
            fall = float(-slope @ step)
            if fall < DONE:
                break
            length = 1.0
            while self.value(x + length * step, weight) > cost - LEAD * length * fall:
                length /= 2
                if length < SHORTEST:
                    return x
            x = x + length * step
        return x

    def value(self, x: Array, weight: float) -> float:
        """The cost; infinite outside."""
        total = weight / 2 * float(np.sum((self.matrix @ x - self.target) ** 2))
        for i, inverse in enumerate(self.inverses):
            pseudo = pseudo_inertia(x[10 * i : 10 * i + 10])
            lower, broken = dpotrf(pseudo, lower=1)
            # Inside is where the slope can be had: eigenvalues say other things of a body on the edge.
            if broken:
                return np.inf
            total += float(np.trace(inverse @ pseudo)) - 2 * float(np.log(np.diag(lower)).sum())
        above = self._above(x)
        if np.any(above[self.bounded] <= 0):
            return np.inf
        logs = np.log(np.where(self.bounded, above, 1.0))
        return total + float(np.sum(np.where(self.bounded, above - logs, above**2 / 2)))

    def _above(self, x: Array) -> Array:
        """Effects' parameters above their bounds, by their typical size."""
        low = np.where(self.bounded, self.low, 0.0)
        return np.asarray((x[10 * self.links :] - low) / self.typical)

    def _cost(self, x: Array, weight: float) -> tuple[float, Array, Array]:
        """The cost, its slope (s,), and R (m, s) with R' R its second derivatives.

        These themselves would lose in great weights' rounding what the divergences say.
        """
        left = self.matrix @ x - self.target
        slope = weight * self.matrix.T @ left
        roots = [np.sqrt(weight) * self.matrix]
        for i, inverse in enumerate(self.inverses):
            own = slice(10 * i, 10 * i + 10)
            lower = np.linalg.inv(np.linalg.cholesky(pseudo_inertia(x[own])))
            turned = lower @ _BASIS @ lower.T
            slope[own] += np.einsum("ij,kji->k", inverse, _BASIS) - np.einsum("kii->k", turned)
            block = np.zeros((16, len(x)))
            block[:, own] = turned.reshape(10, 16).T
            roots.append(block)
        above = self._above(x)
        inside = np.where(self.bounded, above, 1.0)
        rest = slice(10 * self.links, None)
        slope[rest] += np.where(self.bounded, 1 - 1 / inside, above) / self.typical
        roots.append(np.eye(len(x))[rest] / np.abs(inside * self.typical)[:, None])
        return self.value(x, weight), slope, np.vstack(roots)
