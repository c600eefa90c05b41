"""How old the channels of a log are, and which of them are older than the others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset.processing.instants import CLEARLY, UNKNOWN
from modelgen.numeric import Array

FREER = 2.0  # times that free laws change an age, by which it is beyond a sample
SETTLED = 0.05  # samples to which they are found
ALIKE = 0.25  # samples by which channels that are read in turn differ


@dataclass(frozen=True)
class Late:
    """Channels of a joint (from 0, None: of all) that are older than the others by samples.

    positions, efforts: which of the two, or both. noise: deviation of the samples by noise. change: of the
    samples where each joint may have any law of its own.
    """

    joint: int | None
    positions: bool
    efforts: bool
    samples: float
    noise: float
    change: float

    @property
    def clear(self) -> bool:
        """Whether that is clearly more than a sample."""
        return abs(self.samples) - 1.0 > max(CLEARLY * self.noise, FREER * abs(self.change))

    @property
    def deviation(self) -> float:
        """Of the samples."""
        return float(np.linalg.norm([self.noise, self.change, SETTLED]))


@dataclass(frozen=True)
class Ages:
    """How old the channels are (2 n,) [samples], efforts, then positions, and the covariance of that, with
    those that the data tell (2 n,). The first position is the origin. change: of the ages (2 n,) where each
    joint may have any law of its own.
    """

    age: Array
    covariance: Array
    told: NDArray[np.bool_]
    change: Array

    def apart(self) -> tuple[Array, Array]:
        """How much older each channel is than each other (2 n, 2 n), with the deviation, infinite where that
        is not known.
        """
        age, covariance, told = self.age, self.covariance, self.told
        variance = np.diag(covariance)
        square = np.maximum(variance[:, None] + variance - 2.0 * covariance, 0.0)
        return age[:, None] - age, np.where(told[:, None] & told, np.sqrt(square), np.inf)

    def late(self) -> list[Late]:
        """The fewest channels by whose ages the others are alike, each the one that explains most."""
        n = origin = len(self.age) // 2
        kept = np.flatnonzero(self.told & (np.arange(2 * n) != origin))
        covariance = self.covariance[np.ix_(kept, kept)]
        # When all efforts were read is one of the conventions, and nobody knows which.
        together = (kept < n).astype(float)
        expected = ALIKE**2 * (np.eye(len(kept)) + 1.0) + UNKNOWN**2 * np.outer(together, together)
        weights = np.asarray(np.linalg.pinv(covariance + expected), dtype=np.float64)
        places: list[tuple[int | None, bool, bool]] = [(None, False, True)]
        places += [(j, p, e) for j in range(n) for p, e in ((True, False), (False, True), (True, True))]
        shapes = []
        for j, position, effort in places:
            at, there = slice(None) if j is None else slice(j, j + 1), np.zeros((2, n))
            there[0, at], there[1, at] = effort, position
            shapes.append(there.ravel()[kept] - there.ravel()[origin])
        chosen: list[int] = []
        found: list[Late] = []
        for _ in range(n):
            fits = {
                k: self._fit([shapes[i] for i in (*chosen, k)], kept, weights) for k in range(len(places))
            }
            # Of two that say the same the one that is older is named.
            k = min(fits, key=lambda k: (round(fits[k][1], 6), -fits[k][0][-1][0]))
            named = [Late(*places[i], *x) for i, x in zip((*chosen, k), fits[k][0], strict=True)]
            if k in chosen or not named[-1].clear:
                break
            chosen.append(k)
            found = named
        return found

    def _fit(
        self, shapes: Sequence[Array], kept: NDArray[np.intp], weights: Array
    ) -> tuple[list[tuple[float, float, float]], float]:
        """Ages of shapes with deviations and changes, and what is left of the others' (chi squared)."""
        x, y = np.stack(shapes, axis=1), self.age[kept]
        mean = np.linalg.pinv(x.T @ weights @ x) @ x.T @ weights
        left = y - x @ (mean @ y)
        # What the others differ by is expected, and no error of how old these are beside them.
        variances = np.diag(mean @ self.covariance[np.ix_(kept, kept)] @ mean.T)
        deviations = np.sqrt(np.maximum(variances, 0.0))
        found = np.stack([mean @ y, deviations, mean @ self.change[kept]], axis=1)
        return [(float(a), float(d), float(c)) for a, d, c in found], float(left @ weights @ left)
