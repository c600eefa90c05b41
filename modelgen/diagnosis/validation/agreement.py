"""Whether parts of the records agree on a cause's parameters, each fitted alone.

One record may hold little of what tells the cause from the rest of the model, and records that complement
each other all of it: what a part predicts then says more about that part than about the cause. How far the
parts' estimates may lie apart follows from noise like that of the records, drawn anew: what differs between
periods of a record, any of them in the place of each, turned and with any sign.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import lstsq
from scipy.stats import chi2

from modelgen.dataset.processing.periods import noise_of
from modelgen.diagnosis.equations import Equations, Rows
from modelgen.numeric import Array
from modelgen.regression.weighted import stacked, weighted_fit, weights_of

DRAWS = 64  # of noise: a budget, more tell the same with less scatter
SEED = 20010601


class Agreement(NamedTuple):
    """probability: that estimates lie as far apart by noise alone. ratio: how many times farther apart they
    lie than that (Birge 1932), not a number where they cannot be compared.
    """

    probability: float
    ratio: float


def agreement(
    parts: Sequence[tuple[Sequence[Rows], Sequence[int]]],
    equations: Equations,
    columns: Sequence[Array],
    own: int,
) -> Agreement:
    """How well estimates of the columns from `own` on agree (Wald's test).

    parts: rows, and which records they are of; columns: (M, n, p), of all records. A column
    that some part lacks is left out; probability 0 where none is left: what cannot be compared is not agreed
    on.
    """
    rows, periods = equations.rows, equations.periods
    shown = [_shown(some, [columns[i] for i in which]) for some, which in parts]
    kept = [k for k in range(own, columns[0].shape[2]) if all(there[k] for there in shown)]
    if not kept:
        return Agreement(0.0, float("nan"))
    columns = [c[:, :, [*range(own), *kept]] for c in columns]
    theta = weighted_fit(rows, columns)
    weights = weights_of(rows, columns, theta)
    whole, _ = stacked(rows, columns, weights)
    scales = np.linalg.norm(whole, axis=0)
    scales[scales == 0] = 1.0
    random = np.random.default_rng(SEED)
    left = [r.effort - c @ theta for r, c in zip(rows, columns, strict=True)]
    drawn = [_noise(e, r, p, random) for e, r, p in zip(left, rows, periods, strict=True)]
    right = [np.concatenate([e[:, :, None], z], axis=2) for e, z in zip(left, drawn, strict=True)]
    found, ranks = [], []
    for some, which in parts:
        table, _ = stacked(some, [columns[i] for i in which], weights)
        sides, _ = stacked(some, [right[i] for i in which], weights)
        off = lstsq(table / scales, sides, cond=1e-10, lapack_driver="gelsy")[0][own:]
        scatter = np.atleast_2d(np.cov(off[:, 1:]))
        found.append((off[:, 0], np.linalg.pinv(scatter, hermitian=True)))
        ranks.append(int(np.linalg.matrix_rank(scatter, hermitian=True)))
    mean = np.linalg.pinv(sum(w for _, w in found), hermitian=True) @ sum(w @ off for off, w in found)
    apart = sum(float((off - mean) @ w @ (off - mean)) for off, w in found)
    freedom = max(1, sum(ranks) - max(ranks))
    return Agreement(float(chi2.sf(apart, freedom)), float(np.sqrt(apart / freedom)))


def _shown(rows: Sequence[Rows], columns: Sequence[Array]) -> NDArray[np.bool_]:
    """Whether each column (p,) is anything but zero where its joint moves."""
    found = [np.any(c[r.moving], axis=0) for r, c in zip(rows, columns, strict=True)]
    return np.asarray(np.any(found, axis=0))


def _noise(left: Array, rows: Rows, period: int | None, random: np.random.Generator) -> Array:
    """Noise (M, n, DRAWS) like that of residuals (M, n) of one record."""
    values = left * rows.moving
    if period is not None:
        for j in range(left.shape[1]):
            values[:, j], flags = noise_of(left[:, j], rows.moving[:, j], period)
            values[:, j] *= flags
    # rows at rest have none, and come to lie where the joint moves
    values /= np.sqrt(np.maximum(np.mean(values != 0.0, axis=0), 1e-12))
    length = len(values) if period is None else period
    count = max(1, len(values) // length)
    result = np.empty((*values.shape, DRAWS))
    for k in range(DRAWS):
        for begin in range(0, len(values), length):
            source = length * int(random.integers(count))
            turned = np.roll(values[source : source + length], int(random.integers(length)), axis=0)
            size = min(length, len(values) - begin)
            result[begin : begin + size, :, k] = turned[:size] * random.choice((-1.0, 1.0))
    return result
