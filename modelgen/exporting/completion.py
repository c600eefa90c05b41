"""Bodies for base parameters: standard parameters that could exist and give them, or come nearest.

The cost is that of `identification.consistent`: the squared error of the base parameters, and the entropic
divergence of every link from the description's (Lee, Wensing and Park, 2020), here with next to no weight. It
is convex in the standard parameters and infinite outside of what could exist, so that Newton's method goes
from the description's bodies to its minimum (Boyd and Vandenberghe, Convex Optimization, 2004, chapter 9).
"""

from __future__ import annotations

import numpy as np

from modelgen.effects import applied_effects
from modelgen.functions import Model
from modelgen.functions.nominal import base_matrix
from modelgen.identification.consistent import TEN, plain, prior_inertia, pseudo_inertia, violations
from modelgen.numeric import Array

WEIGHTS = 10.0 ** np.arange(0, 13)  # of squared relative errors beside the divergence, one after the other
LEAST = 1e-3  # of what the bodies of the description have, to which an error of less is referred
STEPS = 200  # of Newton's method for one weight
DONE = 1e-10  # decrease of the cost that ends them
SAME = 1e-9  # relative error of a base parameter that is arithmetic
_BASIS = np.array([pseudo_inertia(row) for row in np.eye(10)])  # (10, 4, 4)


def completed(model: Model, theta: Array) -> tuple[Array, Array]:
    """Standard parameters (s,) of bodies that could exist, and the relative errors (p,) of the base
    parameters that they give: zero where those are theta.
    """
    grouping = base_matrix(model)
    near = plain(model, theta)
    size = np.maximum(np.abs(theta), LEAST * np.abs(grouping) @ _sizes(model, near))
    size = np.where(size > 0, size, 1.0)
    problem = _Problem(model, grouping / size[:, None], theta / size, near)
    found = problem.exact(near)
    if found is None:
        nearest = problem.nearest()
        found = problem.exact(nearest)
        if found is None:
            return nearest, (grouping @ nearest - theta) / size
    return found, np.zeros(len(theta))


class _Problem:
    """s standard parameters of m links and of effects; K (p, s) and theta (p,) relative."""

    def __init__(self, model: Model, matrix: Array, theta: Array, near: Array) -> None:
        self.model, self.matrix, self.theta = model, matrix, theta
        self.links = len(model.arm.links)
        priors = [prior_inertia(model, i) for i in range(self.links)]
        self.inverses = [np.linalg.inv(prior) for prior in priors]
        bounds = [p.bounds for effect in applied_effects(model.arm) for p, _ in effect.parameters]
        self.low, self.high = (np.array([b[k] for b in bounds], dtype=float) for k in (0, 1))
        others = near[10 * self.links :]
        self.typical = np.where(others != 0, np.abs(others), 1.0)
        self.bounded = np.isfinite(self.low)
        begin = np.where(self.bounded, np.maximum(others - self.low, 0.1 * self.typical) + self.low, others)
        self.begin = np.concatenate([*(_ten(prior) for prior in priors), begin])

    def nearest(self) -> Array:
        """The minimum for the greatest weight."""
        x = self.begin
        for weight in WEIGHTS:
            x = self._minimum(x, weight)
        return x

    def exact(self, near: Array) -> Array | None:
        """What gives theta next to `near`, None where it could not exist."""
        scale = np.maximum(np.abs(near), 1e-9 * np.abs(near).max())
        change, *_ = np.linalg.lstsq(self.matrix * scale, self.theta - self.matrix @ near, rcond=None)
        found = near + scale * change
        others = found[10 * self.links :]
        # a friction of zero may come out as less than that by rounding
        others[:] = np.where(np.abs(others - self.low) <= SAME * self.typical, self.low, others)
        inside = bool(np.all((others >= self.low) & (others <= self.high)))
        close = bool(np.abs(self.matrix @ found - self.theta).max(initial=0.0) <= SAME)
        return found if inside and close and not violations(self.model, found) else None

    def _minimum(self, x: Array, weight: float) -> Array:
        """Newton's method with steps that are halved until they are inside and lead down."""
        for _ in range(STEPS):
            cost, slope, bend = self._cost(x, weight)
            scale = 1 / np.sqrt(np.diag(bend))
            step = -scale * np.linalg.solve(scale[:, None] * bend * scale, scale * slope)
            fall = float(-slope @ step)
            if fall < DONE:
                break
            length = 1.0
            while length > 1e-12 and not self._value(x + length * step, weight) < cost - 0.1 * length * fall:
                length /= 2
            if length <= 1e-12:
                break
            x = x + length * step
        return x

    def _value(self, x: Array, weight: float) -> float:
        """The cost; infinite outside."""
        total = weight / 2 * float(np.sum((self.matrix @ x - self.theta) ** 2))
        for i, inverse in enumerate(self.inverses):
            pseudo = pseudo_inertia(x[10 * i : 10 * i + 10])
            if np.linalg.eigvalsh(pseudo)[0] <= 0:
                return np.inf
            total += float(np.trace(inverse @ pseudo)) - float(np.linalg.slogdet(pseudo)[1])
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
        """The cost, its slope (s,) and its second derivatives (s, s)."""
        slope = weight * self.matrix.T @ (self.matrix @ x - self.theta)
        bend = weight * self.matrix.T @ self.matrix
        for i, inverse in enumerate(self.inverses):
            own = slice(10 * i, 10 * i + 10)
            turned = np.linalg.inv(pseudo_inertia(x[own])) @ _BASIS
            slope[own] += np.einsum("ij,kji->k", inverse, _BASIS) - np.einsum("kii->k", turned)
            bend[own, own] += np.einsum("kij,lji->kl", turned, turned)
        above = self._above(x)
        inside = np.where(self.bounded, above, 1.0)
        rest = slice(10 * self.links, None)
        slope[rest] += np.where(self.bounded, 1 - 1 / inside, above) / self.typical
        curved = 1 / inside**2 / self.typical**2
        bend[rest, rest] += np.diag(curved)
        return self._value(x, weight), slope, bend


def _sizes(model: Model, near: Array) -> Array:
    """Size (s,) of each standard parameter: of links those of the description's bodies."""
    count = len(model.arm.links)
    found = []
    for i in range(count):
        inertia = prior_inertia(model, i)
        second, mass = float(np.trace(inertia[:3, :3])), float(inertia[3, 3])
        found += [second] * 6 + [np.sqrt(second * mass)] * 3 + [mass]
    return np.concatenate([found, np.abs(near[10 * count :])])


def _ten(pseudo: Array) -> Array:
    """The ten parameters of a pseudo-inertia, in the order of TEN."""
    matrix = _BASIS.reshape(10, 16).T
    found, *_ = np.linalg.lstsq(matrix, pseudo.ravel(), rcond=None)
    assert len(found) == len(TEN)
    return np.asarray(found)
