"""Channels of a log that are older than the others: the positions of a joint, its efforts, or both.

What a joint's inertia and weight do at another joint depends on where it is at that instant: the other's
effort says how old its position is, and its own friction and weight how old it is beside its own effort. The
delays of all channels are fitted beside the parameters (Gauss and Newton). That all are old alike is seen by
nothing: the fewest channels are named beside which the others are alike.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset.processing.instants import LateChannel
from modelgen.evaluation import Motion
from modelgen.identification.channel_ages import SETTLED, Ages
from modelgen.identification.delay_fit import DelayFit, needed
from modelgen.numeric import Array
from modelgen.regression.least_squares import Regression

SUSPECT, APART = 3.0, 0.5  # deviations, beyond as many samples, from which on all delays are fitted
REACH = 0.1  # periods of the cut-off, to either side, over which slopes are taken
LONGEST = 2.5  # periods of the cut-off, of a step
STEPS, HALVES = 12, 5  # of Gauss and Newton, and how often one is halved that leaves more than before
PART = 0.2  # of the deviation, or SETTLED samples, at which they end
WORSE = 1.05  # of what is left of a joint's efforts without them, that no true delays leave
LEAST = 1e-13  # part of columns of unit length that depends on no others
LITTLE = 0.05  # of the logarithm of what is left of an effort, by which a step is to lower it at least
ROWS = 3  # that move, for each parameter and delay
NOTHING = 1e-3  # of the logarithm of what is left, with which they end too


def late_channels(fit: DelayFit, delays: Array, deviations: Array, names: Sequence[str]) -> list[LateChannel]:
    """Channels that are clearly older than all others, with positions among them; none where efforts alone
    are, or where the delays leave as much as none do: then they stand for what the model lacks.

    fit: of the efforts' delays (n,) [samples], which have these deviations. names: of the joints.
    """
    if fit.n == 1 or not fit.theta.any():
        return []
    channels = Channels(fit)
    if not channels.enough or not channels.suspected(delays, deviations):
        return []
    ages, believed = channels.settled()
    late = ages.late()
    if not any(x.positions for x in late):
        return []
    if any(not x.clear or x.joint is None or not believed[x.joint] for x in late):
        return []
    words = {
        (True, False): "positions",
        (False, True): "efforts",
        (True, True): "positions and efforts",
    }
    return [
        LateChannel(names[x.joint], words[x.positions, x.efforts], x.samples, x.deviation)
        for x in late
        if x.joint is not None
    ]


class Channels:
    """Delays of all channels by a fit of the efforts' delays."""

    def __init__(self, fit: DelayFit) -> None:
        self.fit, self.n, self.p = fit, fit.n, fit.p
        first = fit.records[0].record
        self.used = first.hold / first.step
        self.cutoff = (fit.records[0].settings.cutoff or 1.0 / first.step) * first.step
        self.reach = max(1, round(REACH / self.cutoff))

    @property
    def enough(self) -> bool:
        """Whether there are rows for the parameters and the delays of all channels."""
        return sum(int(m.sum()) for m in self.fit.moving) >= ROWS * (self.p + 2 * self.n)

    def suspected(self, delays: Array, deviations: Array) -> bool:
        """Whether channels may be older than others, where the efforts have these delays (n,) alone."""
        off = np.abs(delays - self.used)
        if (off - 1.0 > SUSPECT * deviations).any():
            return True
        fit = self.fit
        efforts, columns = (
            fit.efforts(np.full(self.n, self.used)),
            self._columns(fit.theta, both=False),
        )
        found = self._as_ages(*_normal(efforts, columns, fit.moving, fit.sigma))
        older, deviations = found.apart()
        return bool((np.abs(older) - APART > SUSPECT * deviations).any())

    def settled(self) -> tuple[Ages, NDArray[np.bool_]]:
        """Delays of all channels, and joints (n,) of which little but noise is left with them, free laws
        beside, and no more than without; no joint where such laws alone explain it.
        """
        fit, n = self.fit, self.n
        delays, positions = np.full(n, self.used), np.zeros(n)
        fit.at(positions, fit.theta)
        efforts = fit.efforts(delays)
        theta, sigma = self._left(efforts, fit.sigma)
        first = sigma
        _, lawful = fit.beside_free_laws(efforts, fit.columns, theta, sigma)
        longest = LONGEST / self.cutoff
        for _ in range(STEPS):
            columns = self._columns(theta)
            found = self._as_ages(*_normal(efforts, columns, fit.moving, sigma))
            deviations = np.sqrt(np.diag(found.covariance))
            step = np.where(found.told, np.clip(found.age, -longest, longest), 0.0)
            if (np.abs(step) <= np.maximum(SETTLED, PART * deviations)).all():
                break
            for _ in range(HALVES):
                trial = delays - step[:n], positions + step[n:]
                self._leave_ends(*trial)
                if self.enough:
                    fit.at(trial[1], theta)
                    efforts = fit.efforts(trial[0])
                    after = self._left(efforts, sigma)
                    gain = float(np.log(sigma / after[1]).sum())
                    if gain > 0.0:
                        break
                step = step / 2.0
            else:
                self._leave_ends(delays, positions)
                fit.at(positions, theta)
                efforts = fit.efforts(delays)
                break
            (theta, sigma), (delays, positions) = after, trial
            lost = float(np.log(first / sigma).sum()) < LITTLE * n and bool(fit.lacks(sigma, first).all())
            if gain < NOTHING or lost:
                break
        columns = self._columns(theta)
        solution = Regression(efforts, columns, fit.moving).solve("wls")
        found = self._as_ages(solution.theta, solution.covariance, solution.determined)
        free, left = fit.beside_free_laws(efforts, columns, theta, sigma)
        change = np.concatenate([-free[:n], [0.0], free[n:]])
        ages = Ages(self._ages(delays, positions), found.covariance, found.told, change)
        believed = ~fit.lacks(np.minimum(left, sigma), first) & (sigma <= WORSE * first)
        return ages, believed & needed(lawful, left, sigma)

    def _leave_ends(self, delays: Array, positions: Array) -> None:
        """Rows near the ends of the records do not count: what is moved there is not in the log."""
        reach = np.ceil(max(np.abs(delays).max(), np.abs(positions).max())) + self.reach
        self.fit.moving = [
            r.moving & ((r.rows >= reach) & (r.rows < len(r.time) - reach))[:, None] for r in self.fit.records
        ]

    def _left(self, efforts: Sequence[Array], sigma: Array) -> tuple[Array, Array]:
        """Parameters (p,) with the joints weighted by sigma (n,), and what they leave of the efforts (n,)."""
        fit = self.fit
        theta, *_ = _normal(efforts, fit.columns, fit.moving, sigma)
        left = Regression(efforts, fit.columns, fit.moving).residuals(theta)
        squares = sum((e**2 * m).sum(axis=0) for e, m in zip(left, fit.moving, strict=True))
        rows = sum(m.sum(axis=0) for m in fit.moving)
        return theta, np.maximum(np.sqrt(squares / np.maximum(rows, 1)), 1e-300)

    def _ages(self, delays: Array, positions: Array) -> Array:
        return np.concatenate([self.used - delays, positions])

    def _as_ages(self, theta: Array, covariance: Array, determined: NDArray[np.bool_]) -> Ages:
        """Ages of the channels by a solution for parameters and delays."""
        n, p = self.n, self.p
        sign = np.concatenate([-np.ones(n), np.ones(n - 1)])
        kept = np.delete(np.arange(2 * n), n)  # the first position is the others' origin
        age, whole = np.zeros(2 * n), np.zeros((2 * n, 2 * n))
        age[kept] = sign * theta[p:]
        whole[np.ix_(kept, kept)] = sign[:, None] * covariance[p:, p:] * sign
        return Ages(age, whole, np.insert(determined[p:], n, True), np.zeros(2 * n))

    def _columns(self, theta: Array, *, both: bool = True) -> list[Array]:
        """Columns (M, n, p + 2 n - 1) of each record: with the delays of efforts and of positions but one.

        both: whether slopes reach to both sides, or ahead alone, at half the cost.
        """
        fit, n, made = self.fit, self.n, []
        ends = (self.reach, -self.reach if both else 0)
        over = float(ends[0] - ends[1])
        for k, own in enumerate(fit.columns):
            r, motion, weights, now = fit.records[k], fit.motions[k], fit.weights[k], fit.full[k] @ theta
            more = np.zeros((len(own), n, 2 * n - 1))
            ahead, behind = (_beside(now, way) for way in ends)
            more[:, range(n), range(n)] = r.parallel((ahead - behind) / over * weights)
            for j in range(1, n):
                ahead, behind = (self._efforts(motion, j, way, theta) if way else now for way in ends)
                more[:, :, n + j - 1] = r.parallel((ahead - behind) / over * weights)
            made.append(np.concatenate([own, more], axis=2))
        return made

    def _efforts(self, motion: Motion, joint: int, way: int, theta: Array) -> Array:
        """Efforts (N, n) of the model where one joint is some samples ahead, or behind."""
        q, dq, ddq = (x.copy() for x in (motion.q, motion.dq, motion.ddq))
        for x in (q, dq, ddq):
            x[:, joint] = _beside(x[:, joint], way)
        there = replace(motion, q=q, dq=dq, ddq=ddq)
        columns = np.asarray(self.fit.evaluator.regressor(self.fit.model, there, theta))
        return columns @ theta + self.fit.evaluator.unseen(there, columns, theta)


def _beside(x: Array, way: int) -> Array:
    """x (N, ...) some samples later, or earlier; at the ends as it is there."""
    return np.asarray(x[np.clip(np.arange(len(x)) + way, 0, len(x) - 1)])


def _normal(
    efforts: Sequence[Array],
    columns: Sequence[Array],
    moving: Sequence[NDArray[np.bool_]],
    sigma: Array,
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Parameters (p,) by least squares, their covariance as of white noise, and flags: all.

    sigma: (n,) of that noise. What rows do not determine has a deviation far beyond any parameter.
    """
    rows = [m / sigma for m in moving]
    x = np.concatenate(
        [(c * w[:, :, None]).reshape(-1, c.shape[2]) for c, w in zip(columns, rows, strict=True)]
    )
    y = np.concatenate([(e * w).ravel() for e, w in zip(efforts, rows, strict=True)])
    norms = np.linalg.norm(x, axis=0)
    scale = np.where(norms > 0.0, norms, 1.0)
    values, vectors = np.linalg.eigh((x.T @ x) / np.outer(scale, scale))
    inverse = (vectors / np.maximum(values, LEAST)) @ vectors.T / np.outer(scale, scale)
    return inverse @ (x.T @ y), inverse, np.ones(len(scale), dtype=bool)
