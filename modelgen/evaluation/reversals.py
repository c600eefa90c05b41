"""Samples within which joints turn back: what jumps there counts with its mean over the sample.

An effort that is held over a sample tells of dry friction by its mean: where a joint turns back a third of
the sample before its end, a third of it has the new sign. The sign at the instant of the stamp would leave an
error there that repeats with the motion and looks like a law of friction.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from modelgen.numeric import Array


@dataclass(frozen=True)
class Pieces:
    """Parts of samples between the instants at which joints turn back.

    sample: (R,), number of the sample of each part, rising; place: (R,), its middle, -1/2 to 1/2 of a sample
    after the stamp; share: (R,), of the sample; change: (R, n), of the speeds from one sample to the next.
    """

    sample: NDArray[np.intp]
    place: Array
    share: Array
    change: Array

    def speeds(self, dq: Array) -> Array:
        """Speeds (R, n) in the middle of the parts, of those at the stamps (N, n)."""
        return np.asarray(dq[self.sample] + self.place[:, None] * self.change)

    def means(self, values: Array) -> tuple[NDArray[np.intp], Array]:
        """Samples (S,) that have parts, and means over each of values in its parts (R, ...)."""
        samples, first = np.unique(self.sample, return_index=True)
        weighted = values * self.share.reshape(-1, *[1] * (values.ndim - 1))
        return samples, np.add.reduceat(weighted, first, axis=0)


def pieces_of(dq: Array) -> Pieces | None:
    """Parts of the samples within which speeds (N, n) change sign, None where none does."""
    if len(dq) < 2:
        return None
    change = np.gradient(dq, axis=0)
    turning = np.abs(dq) < np.abs(change) / 2
    samples = np.flatnonzero(turning.any(axis=1))
    if not len(samples):
        return None
    slope = np.where(turning[samples], change[samples], 1.0)
    turns = np.where(turning[samples], -dq[samples] / slope, 0.5)
    edges = np.sort(
        np.hstack([np.full((len(samples), 1), -0.5), turns, np.full((len(samples), 1), 0.5)]), axis=1
    )
    share = np.diff(edges, axis=1)
    there = share > 0.0
    sample = np.repeat(samples, there.sum(axis=1))
    return Pieces(sample, ((edges[:, 1:] + edges[:, :-1]) / 2)[there], share[there], change[sample])
