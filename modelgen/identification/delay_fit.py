"""Delays of a log's channels beside the parameters of a model, by Gauss and Newton's steps.

The column of an effort's delay is the slope of the effort as the model has it, in which its noise has no
part. The column of a position's is what the efforts of all joints change where that joint alone is where it
was or will be. What the model lacks is no noise: where each joint may have any law of its own position, speed
and load, and dry friction that turns late, the delays change by as much as it pulls them (Hausman 1978).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset import Prepared
from modelgen.dataset.processing.content import white_noise
from modelgen.dataset.processing.filters import advanced
from modelgen.evaluation import Evaluator
from modelgen.evaluation.link_encoder import compliant
from modelgen.functions import Model
from modelgen.identification.rows import motion_of
from modelgen.identification.unexplained import FAR
from modelgen.numeric import Array
from modelgen.regression.least_squares import Regression

STEPS = 20  # of Gauss and Newton, and as many at most that go on as far as they may
LONGEST, TURNED = 2.0, 0.1  # samples, of a step, or periods of the cut-off where these are more
SETTLED = 0.02  # samples, or this part of the deviation, at which they end
WAVES = (0.5, 1, 1.5, 2, 3)  # in the range of a joint, of which its free law of position is made
SLOW = (0.05, 0.2)  # of the highest speed, below which a law of friction may be another
ALONE, MORE = 0.7, 1.5  # of what delays leave, what free laws leave beside them; times, what such laws leave
EXPLAINS = 0.25  # of what is left without it, that a delay beyond a sample may leave to be believed


class DelayFit:
    """Records, and the columns (M, n, p) of their model away from rest."""

    def __init__(self, records: Sequence[Prepared], model: Model, evaluator: Evaluator) -> None:
        self.records, self.model, self.evaluator = records, model, evaluator
        self.n, self.p = records[0].n, len(model.grouping.base)
        self.moving = [r.moving for r in records]
        self.missing = np.zeros(self.n, dtype=bool)
        self.theta, self.sigma = np.zeros(self.p), np.ones(self.n)
        self.at(np.zeros(self.n), self.theta)

    def at(self, positions: Array, theta: Array) -> None:
        """The columns where the positions of the joints are (n,) samples older than their stamps."""
        moved = [[earlier(x, positions) for x in (r.q, r.dq, r.ddq)] for r in self.records]
        self.motions = [
            replace(motion_of(r), q=q, dq=dq, ddq=ddq, held=False)
            for r, (q, dq, ddq) in zip(self.records, moved, strict=True)
        ]
        self.weights = [r.weights for r in self.records]
        if positions.any():
            at = np.rint(positions)
            self.weights = [r.weighted(earlier(r.awake.astype(float), at) > 0.5) for r in self.records]
        self._evaluate(theta)

    def _evaluate(self, theta: Array) -> None:
        self.full = [np.asarray(self.evaluator.regressor(self.model, m, theta)) for m in self.motions]
        both = zip(self.motions, self.full, strict=True)
        self.unseen = [self.evaluator.unseen(motion, full, theta) for motion, full in both]
        if not all(np.isfinite(x).all() for x in self.unseen):
            raise FloatingPointError("an elastic joint runs away")
        parts = zip(self.records, self.full, self.weights, strict=True)
        self.columns = [r.parallel(full * weights[:, :, None]) for r, full, weights in parts]

    def delays(self, *, free: bool = True) -> tuple[Array, Array]:
        """Delays of the joints (n,) and their deviations [samples], infinite for those that do not tell.

        free: whether these hold what free laws beside the model change.
        """
        first = self.records[0].record
        delays = np.full(self.n, first.hold / first.step)
        efforts = self.efforts(delays)
        if sum(int(m.sum()) for m in self.moving) < 3 * (self.p + self.n):
            return delays, np.full(self.n, np.inf)
        without = Regression(efforts, self.columns, self.moving).solve("wls")
        self.theta, self.sigma = without.theta, without.sigma
        theta = without.theta
        self._evaluate(theta)
        if compliant(self.model.arm):
            efforts = self.efforts(delays)
        told, deviations = np.ones(self.n, dtype=bool), np.full(self.n, np.inf)
        cutoff = self.records[0].settings.cutoff or 1.0 / first.step
        longest = max(LONGEST, TURNED / (cutoff * first.step))
        near, way = 0, np.zeros(self.n)  # steps that do not go on as far as they may; where the last one went
        for _ in range(2 * STEPS):
            columns = self.with_delays(theta)
            solution = Regression(efforts, columns, self.moving).solve("wls")
            before, theta, moved = theta, solution.theta[: self.p], solution.theta[self.p :]
            told = solution.determined[self.p :] & np.isfinite(moved)
            deviations = np.sqrt(np.maximum(np.diag(solution.covariance)[self.p :], 0.0))
            delays = delays + np.where(told, np.clip(moved, -longest, longest), 0.0)
            settled = (np.abs(moved[told]) <= np.maximum(SETTLED, SETTLED * deviations[told])).all()
            if compliant(self.model.arm):  # what elastic joints add follows from the parameters
                self._evaluate(theta)
                settled &= np.allclose(theta, before, rtol=SETTLED)
            if settled:
                break
            efforts = self.efforts(delays)
            near += not (told & (way * moved > longest)).any()
            way = np.sign(moved)
            if near == STEPS:
                break
        if not settled:
            told &= np.abs(moved) <= deviations
        self.missing = self.lacks(solution.sigma, without.sigma)
        if free:
            change, left = self.beside_free_laws(efforts, columns, theta, solution.sigma)
            deviations = np.hypot(deviations, change)
            if (np.abs(delays - first.hold / first.step) > 1.0).any():
                efforts = self.efforts(np.full(self.n, first.hold / first.step))
                _, freely = self.beside_free_laws(efforts, self.columns, without.theta, without.sigma)
                self.missing |= ~needed(freely, left, solution.sigma)
        return delays, np.where(told & (deviations > 0.0), deviations, np.inf)

    def lacks(self, left: Array, without: Array) -> NDArray[np.bool_]:
        """Joints (n,) at which more than noise is left with the delays, and not much less than without.

        Then it is causes that the model lacks that are left, and a delay may stand for one of them.
        """
        square = np.zeros(self.n)
        for r in self.records:
            assert r.record.input is not None
            rate = 1.0 / r.record.step
            band = min(1.0, 2.0 * r.settings.cutoff / rate) if r.settings.cutoff else 1.0
            square += band * np.array([white_noise(x, rate) for x in r.record.input.T]) ** 2
        noise = np.sqrt(square / len(self.records))
        return np.asarray((left > FAR * noise) & (left > EXPLAINS * without))

    def with_delays(self, theta: Array) -> list[Array]:
        """Columns (M, n, p + n) of each record: those of the model, and the slopes of its efforts."""
        columns = []
        for (r, own, full, weights), unseen in zip(self._parts(self.columns), self.unseen, strict=True):
            slope = r.parallel(np.gradient(full @ theta + unseen, axis=0) * weights)
            more = np.zeros((len(slope), self.n, self.n))
            more[:, range(self.n), range(self.n)] = slope
            columns.append(np.concatenate([own, more], axis=2))
        return columns

    def beside_free_laws(
        self, efforts: Sequence[Array], columns: Sequence[Array], theta: Array, sigma: Array
    ) -> tuple[Array, Array]:
        """Changes of the delays (k,) where each joint may have any law of its position, speed and load, and
        what is left of the efforts then (n,). columns: (M, n, p + k) of each record. sigma: (n,), of
        the efforts without them.
        """
        low = np.min([r.q.min(axis=0) for r in self.records], axis=0)
        high = np.max([r.q.max(axis=0) for r in self.records], axis=0)
        fast = np.max([np.abs(r.dq).max(axis=0) for r in self.records], axis=0)
        freer = []
        for k, (r, own, full, weights) in enumerate(self._parts(columns)):
            q, dq = self.motions[k].q, self.motions[k].dq
            laws = _laws(
                (q - low) / np.maximum(high - low, 1e-300), dq / np.maximum(fast, 1e-300), full @ theta
            )
            count = laws.shape[2]
            more = np.zeros((len(own), self.n, self.n * count))
            for j in range(self.n):
                more[:, j, j * count : (j + 1) * count] = r.parallel(laws[:, j] * weights[:, j, None])
            freer.append(np.concatenate([own, more], axis=2))
        weighted = [x / sigma[:, None] for x in freer], [y / sigma for y in efforts]
        regression = Regression(weighted[1], weighted[0], self.moving)
        found = regression.least_squares()
        squares = sum(
            (e**2 * m).sum(axis=0) for e, m in zip(regression.residuals(found), self.moving, strict=True)
        )
        rows = sum(m.sum(axis=0) for m in self.moving)
        left = sigma * np.sqrt(squares / np.maximum(rows, 1))
        return found[self.p : own.shape[2]], np.asarray(left)

    def _parts(self, columns: Sequence[Array]) -> list[tuple[Prepared, Array, Array, Array]]:
        """Each record with its columns, the regressor at full rate, and the weights of the samples."""
        return list(zip(self.records, columns, self.full, self.weights, strict=True))

    def efforts(self, delays: Array) -> list[Array]:
        """Efforts (M, n) at the positions' instants, where their samples lie `delays` samples after them."""
        found = []
        parts = zip(self.records, self.motions, self.unseen, self.weights, strict=True)
        for r, motion, unseen, weights in parts:
            assert r.record.input is not None
            given = earlier(r.record.input, -delays)
            ideal = self.evaluator.ideal(self.model, motion, given) - unseen
            found.append(r.parallel(ideal * weights))
        return found


def needed(without: Array, left: Array, delayed: Array) -> NDArray[np.bool_]:
    """Joints (n,) whose efforts delays explain: hardly less is left beside free laws too, or far more by such
    laws alone. left, without: beside free laws, with delays and without; delayed: with delays alone, (n,).
    """
    return np.asarray((left >= ALONE * delayed) | (without > MORE * left))


def earlier(x: Array, delays: Array) -> Array:
    """x (N, n) at the stamps, where each column was read so many samples (n,) before them."""
    if not delays.any():
        return x
    columns = (advanced(c[:, None], -float(d), held=False)[:, 0] for c, d in zip(x.T, delays, strict=True))
    return np.column_stack(list(columns))


def _laws(q: Array, dq: Array, effort: Array) -> Array:
    """Laws (N, n, k) of positions in their range [0, 1], speeds over the highest, and loads, (N, n) each.

    The last but one is dry friction that turns late: a joint that creeps before it goes, bristles that bend.
    """
    sign = np.sign(dq)
    waves = [f(2 * np.pi * k * q) for k in WAVES for f in (np.sin, np.cos)]
    drags = [sign * np.abs(dq) ** k for k in (2, 3)]
    stops = [sign * np.exp(-((dq / v) ** 2)) for v in SLOW]
    loads = [effort * dq, np.abs(effort) * sign, sign * q, sign * q**2]
    late = np.gradient(sign, axis=0)
    return np.stack([*waves, *drags, *stops, *loads, late, np.ones_like(q)], axis=2)
