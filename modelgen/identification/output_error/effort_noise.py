"""What noise of the measured efforts does to a simulated motion, and to what is fitted to it.

An effort that is off at one instant leaves all of the motion after it off, so that errors of positions hang
together as long as the motion itself. Their sum over time is no measure of that: it is followed through the
linearised motion.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.optimize import nnls

from modelgen.numeric import Array

# Deviations by which bends exceed those of white noise: of a sum of N squares, and of the noise that it is
# compared with, that is sqrt(8 / N) of it, since neighbours share readings.
CLEARLY = 3.0
DRAWS = 8  # of noise at each drive, by which its share of the errors is found
_SECOND, _THIRD = 6.0, 20.0  # sums of squares of the weights of differences: 1, 2, 1 and 1, 3, 3, 1


def scatter(
    errors: Sequence[Array],
    columns: Sequence[Array],
    bases: Sequence[Array],
    steps: Sequence[Array],
    weights: Array,
) -> Array:
    """Covariance (f, f) of X' e, from white noise of the efforts and of the positions, by part.

    errors (K, n) and columns (K, n, f): weighted, without what the initial states explain; bases: of that
    share, (K n, m). steps: as of `Sensitive.disturbed`. weights: (n,).
    """
    f = columns[0].shape[2]
    positions = np.sum([(np.diff(e, 3, axis=0) ** 2).sum(axis=0) for e in errors], axis=0)
    positions /= _THIRD * sum(len(e) - 3 for e in errors)
    sizes = _sizes(errors, _left(columns, bases, steps, weights), positions)
    total = np.zeros((f, f))
    for c, step in zip(columns, steps, strict=True):
        for j, size in enumerate(positions):
            total += size * c[:, j].T @ c[:, j]
        follow = _followed_back(step, c * weights[:, None])
        total += np.einsum("kif,kig,i->fg", follow, follow, sizes)
    return total


def _sizes(errors: Sequence[Array], left: Sequence[Array], positions: Array) -> Array:
    """Variances (n,) of the noise of every drive's effort, from the bends of the errors by joint.

    left: what unit noise of each drive leaves, (K, n, n, DRAWS), the joint first. positions: variances (n,).
    Over longer times efforts show more beside the positions, in fewer bends: each joint has the lag at which
    they are known best, and none where bends are no more than chance makes of the positions' noise.
    """
    n, longest = errors[0].shape[1], min(len(e) for e in errors) // 4
    shares, squares, least = np.zeros((n, n)), np.zeros(n), np.full(n, np.inf)
    for lag in (2**k for k in range(max(1, longest).bit_length())):
        found = np.sum([(_bends(e, lag) ** 2).sum(axis=0) for e in errors], axis=0)
        own = np.sum([(_bends(x, lag) ** 2).sum(axis=0) for x in left], axis=0).mean(axis=2)
        count = sum(len(e) - 2 * lag for e in errors)
        beyond = found - _SECOND * positions * count
        beyond[beyond < CLEARLY * found * np.sqrt(8.0 / count)] = 0.0
        doubt = lag * (found / np.maximum(beyond, 1e-12 * found + 1e-300)) ** 2
        better = doubt < least
        least[better], squares[better], shares[better] = doubt[better], beyond[better], own[better]
    return np.asarray(nnls(shares, np.maximum(squares, 0.0))[0])


def _bends(path: Array, lag: int) -> Array:
    """Second differences over a lag."""
    return np.asarray(path[2 * lag :] - 2.0 * path[lag:-lag] + path[: -2 * lag])


def _left(
    columns: Sequence[Array], bases: Sequence[Array], steps: Sequence[Array], weights: Array
) -> list[Array]:
    """What noise of unit size of every drive's effort (third) leaves at each joint (second) beside a fit, in
    each draw: (K, n, n, DRAWS).
    """
    n, f = len(weights), columns[0].shape[2]
    random = np.random.default_rng(0)
    made = []
    for u, step in zip(bases, steps, strict=True):
        noise = np.zeros((len(step), n, n, DRAWS))
        for i in range(n):
            noise[:, i, i] = random.standard_normal((len(step), DRAWS))
        path = _moved(step, noise.reshape(len(step), n, -1)) * weights[:, None]
        flat = path.reshape(-1, n * DRAWS)
        made.append(flat - u @ (u.T @ flat))
    flat_columns = [c.reshape(-1, f) for c in columns]
    size = np.linalg.norm(np.concatenate(flat_columns), axis=0)
    normal = sum((c.T @ c for c in flat_columns), np.zeros((f, f))) / np.outer(size, size)
    found = sum(c.T @ flat for c, flat in zip(flat_columns, made, strict=True))
    fitted = np.linalg.solve(normal, found / size[:, None]) / size[:, None]
    return [(flat - c @ fitted).reshape(-1, n, n, DRAWS) for c, flat in zip(flat_columns, made, strict=True)]


def _moved(step: Array, noise: Array) -> Array:
    """Positions (K, n, d) after noise (K - 1, n, d) of the efforts held over each interval."""
    n, m = noise.shape[1], 2 * noise.shape[1]
    state, path = np.zeros((m, noise.shape[2])), np.zeros((len(step) + 1, n, noise.shape[2]))
    for k, (one, w) in enumerate(zip(step, noise, strict=True)):
        state = one[:, :m] @ state + one[:, m:] @ w
        path[k + 1] = state[:n]
    return path


def _followed_back(step: Array, values: Array) -> Array:
    """Derivatives (K - 1, n, f), by the effort of every interval, of the sum over the positions (K, n) times
    values (K, n, f).
    """
    n, f = values.shape[1:]
    m = 2 * n
    state, found = np.zeros((m, f)), np.zeros((len(step), n, f))
    for k in range(len(step) - 1, -1, -1):
        state[:n] += values[k + 1]
        found[k] = step[k][:, m:].T @ state
        state = step[k][:, :m].T @ state
    return found
