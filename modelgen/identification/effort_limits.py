"""Limits of efforts, and the samples that they may have changed by what a model asks for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset import Prepared
from modelgen.evaluation import Evaluator, predicted
from modelgen.functions import Model
from modelgen.identification.rows import motion_of
from modelgen.numeric import Array

CLEAR = 3.0  # deviations of the noise below the limit, from which on it does nothing
MOST = 0.95, 1.96  # of the samples of normal noise, and the deviations that these are within


@dataclass(frozen=True)
class End:
    """The reading at which an effort may be cut off. sign: 1 the highest, -1 the lowest. step: of the
    readings, 0 where they are fine. shown: whether the readings alone show it.
    """

    joint: int
    sign: int
    reading: float
    step: float
    shown: bool

    @property
    def edge(self) -> float:
        """Effort up to which a reading is what it would be without a limit."""
        return self.reading + self.sign * self.step / 2

    def rounded(self, effort: Array) -> Array:
        """Efforts (N,) as they are read."""
        if not self.step:
            return effort
        return np.asarray(self.reading + self.step * np.rint((effort - self.reading) / self.step))

    def clipped(self, effort: Array) -> Array:
        """Efforts (N,) that end at the reading."""
        return np.asarray((np.minimum if self.sign > 0 else np.maximum)(effort, self.reading))


def logged_of(p: Prepared) -> Array:
    """Efforts (N, n) as the log carried them, in its units."""
    logged = p.record.logged_effort
    assert logged is not None
    return logged


def gain_of(p: Prepared) -> Array:
    """Factor (N, n) from inputs to what the log carried."""
    return np.ones_like(p.q) if p.gain is None else p.gain


def ideal_of(p: Prepared, model: Model, evaluator: Evaluator, theta: Array) -> Array:
    """What the log would carry of the model's efforts (N, n)."""
    return np.asarray(predicted(evaluator, model, motion_of(p), theta) * gain_of(p))


def beside(flags: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Samples beside those that are named: efforts at the instants of the positions have a part of both."""
    found = np.zeros_like(flags)
    for k in (1, 2):
        found[k:] |= flags[:-k]
        found[:-k] |= flags[k:]
    return found


@dataclass(frozen=True)
class Beyond:
    """What tells samples at which efforts are cut off.

    theta: base parameters (p,) of the model; covariance: (p, p), of a fit without any sample at the readings
    of the ends. noise: (n,) of the logged efforts beside their rounding.
    """

    ends: Sequence[End]
    model: Model
    evaluator: Evaluator
    theta: Array
    noise: Array
    covariance: Array

    def of(self, p: Prepared) -> NDArray[np.bool_]:
        """Samples (N, n) that the limits may have changed.

        Those that the model does not know about are among them, and those that were read far below are not,
        whatever it says.
        """
        motion, logged, gain = motion_of(p), logged_of(p), gain_of(p)
        columns = self.evaluator.regressor(self.model, motion, self.theta)
        unseen = self.evaluator.unseen(motion, columns, self.theta)
        ideal = (columns @ self.theta + unseen + self.evaluator.known.inputs(motion)) * gain
        found = np.zeros(p.q.shape, dtype=bool)
        for e in self.ends:
            j, x = e.joint, columns[:, e.joint] * gain[:, e.joint, None]
            noise = CLEAR * self.noise[j]
            unsure = np.sqrt(np.maximum(np.einsum("ij,jk,ik->i", x, self.covariance, x), 0.0))
            asked = e.sign * (ideal[:, j] - e.edge) > -noise - CLEAR * unsure
            found[:, j] |= asked & (e.sign * (logged[:, j] - e.reading) >= -2.0 * noise - e.step)
        return np.asarray(found | beside(found))

    def noise_of(self, prepared: Sequence[Prepared]) -> Array:
        """Noise of the logged efforts (n,) beside their rounding, away from the limits.

        Of noise that is small beside the steps so many readings are another than the one expected as its mean
        size is of a step. Some samples are farther off, as where a joint turns back.
        """
        size = np.zeros(prepared[0].n)
        ideal = [ideal_of(p, self.model, self.evaluator, self.theta) for p in prepared]
        flags = [self.of(p) for p in prepared]
        for j in {e.joint for e in self.ends}:
            end = next(e for e in self.ends if e.joint == j)
            step, left, other = end.step, [], []
            for p, x, beyond in zip(prepared, ideal, flags, strict=True):
                inside = p.awake[:, j] & ~beyond[:, j]
                expected, read = x[inside, j], logged_of(p)[inside, j]
                left.append(np.abs(read - expected))
                other.append(np.abs(read - end.rounded(expected)) > step / 2.0)
            every = np.concatenate(left)
            if len(every):
                most = float(np.quantile(every, MOST[0])) / MOST[1]
                small = step * np.sqrt(np.pi / 2.0) * float(np.mean(np.concatenate(other))) if step else 0.0
                size[j] = max(np.sqrt(max(most**2 - step**2 / 12.0, 0.0)), small)
        return size
