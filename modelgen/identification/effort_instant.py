"""When the efforts of a log were read: the delay at which the model explains them best.

The delay of each joint's efforts is fitted beside the parameters by Gauss and Newton's steps. Its column is
the slope of the efforts as the model has them, in which their noise has no part. The columns of inertia and
friction are slopes of others, and what is left for the delay is little: its deviation says how little. What
the rounding of the positions does to it is seen by rounding them again (Cook and Stefanski 1994). What the
model lacks is no noise, and pulls the delays of all parts of a log the same way: the deviation holds how much
they change where every joint may have any law of its own position, speed and load, and dry friction that
turns late (Hausman 1978). A delay of more than a sample that leaves nearly as much as none stands for what is
missing, and is not given.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset import Prepared, Record, Settings, choose, drives_of, prepare
from modelgen.dataset.processing.content import white_noise
from modelgen.dataset.processing.filters import advanced
from modelgen.dataset.processing.instants import EffortInstant, beyond, fitting, with_hold
from modelgen.dataset.processing.rounding import position_steps
from modelgen.dataset.thresholds import USUAL, DatasetThresholds
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator, Motion
from modelgen.functions import Model, Options, build_model
from modelgen.functions.options import prepared as reduced
from modelgen.identification.unexplained import FAR
from modelgen.numeric import Array
from modelgen.regression.least_squares import Regression

STEPS = 20  # of Gauss and Newton, and as many at most that go on as far as they may
LONGEST, TURNED = 2.0, 0.1  # samples, of a step, or periods of the cut-off where these are more
SETTLED = 0.02  # samples, or this part of the deviation, at which they end
ELEMENTS = 25_000_000  # of the regressor at full rate, beyond which the beginnings of the records do
WAVES = (0.5, 1, 1.5, 2, 3)  # in the range of a joint, of which its free law of position is made
SLOW = (0.05, 0.2)  # of the highest speed, below which a law of friction may be another
DRAWS = 4  # of further roundings of the positions, where the data would tell without
ALIKE = 0.25  # samples, half of what is between two conventions: joints that are so near agree
EXPLAINS = 0.25  # of what is left without it, that a delay beyond a sample may leave to be believed
APART = 4.0  # deviations by which a joint may be from all, if it is a matter of the log


def effort_instant(
    records: Sequence[Record], arm: Arm, limits: DatasetThresholds = USUAL
) -> EffortInstant | None:
    """When the efforts of the records, which are read alike, were read; None of free motions.

    What nobody has said is as the data say, where they can tell, and as the default else.
    """
    first = records[0]
    if any(r.input is None for r in records):
        return None
    known = EffortInstant(first.effort_hold, first.hold_known, first.step)
    found = _delay(records, arm, limits)
    if found is None:
        return known
    delay, std, alike, joints = found
    fits, used = fitting(delay, std, first.step, limits) if alike else None, first.hold / first.step
    late = tuple((name, d) for name, d, s, believed in joints if believed and beyond(d, s, used))
    if fits is None and not all(believed for *_, believed in joints):
        return replace(known, late=late, alike=False, missing=True)
    said = EffortInstant(known.hold, known.known, known.step, delay, std, fits, alike, late)
    if fits is None or known.known or fits == known.hold:
        return said
    return EffortInstant(fits, "data", known.step, delay, std, fits)


def at_instants(records: Sequence[Record], found: EffortInstant | None) -> list[Record]:
    """The records with their efforts at the instants found."""
    if found is None or found.known != "data":
        return list(records)
    return [record if record.input is None else with_hold(record, found.hold) for record in records]


def _delay(
    records: Sequence[Record], arm: Arm, limits: DatasetThresholds
) -> tuple[float, float, bool, list[tuple[str, float, float, bool]]] | None:
    """Common delay and its deviation [samples], whether the joints agree, and name, delay and deviation of
    each that tells, and whether it is to be believed; None where there is none.
    """
    chosen = Options().evaluated
    model, evaluator = build_model(arm, chosen), Evaluator(reduced(arm, chosen))
    n, p = records[0].n, len(model.grouping.base)
    longest = max(limits.min_samples, ELEMENTS // (n * p * len(records)))
    beginnings = [r.part(0, min(len(r.t), longest)) for r in records]
    try:
        settings = choose(list(records), Settings(thresholds=limits))
        prepared = [prepare(r, settings) for r in beginnings]
        fit = _Fit(prepared, model, evaluator)
        delays, deviations = fit.delays()
        if not np.isfinite(deviations).any():
            return None
        if _common(delays, deviations)[1] <= limits.max_instant_std and position_steps(records[0]).any():
            square = np.zeros(n)
            for seed in range(DRAWS):
                again = [prepare(_rounded_anew(r, seed), settings) for r in prepared]
                square += (_Fit(again, model, evaluator).delays(free=False)[0] - delays) ** 2 / DRAWS
            deviations = np.sqrt(deviations**2 + np.where(np.isfinite(square), square, np.inf))
    except (InputError, np.linalg.LinAlgError, FloatingPointError):
        return None  # what is wrong is said where the parameters are found
    told = np.isfinite(deviations)
    if not told.any():
        return None
    common, std = _common(delays, deviations)
    apart = np.maximum(APART * deviations, ALIKE)
    names = np.array(arm.coordinate_names)[told].tolist()
    used = records[0].hold / records[0].step
    believed = ~fit.missing | (np.abs(delays - used) <= 1.0)
    columns = (x[told].tolist() for x in (delays, deviations, believed))
    joints = list(zip(names, *columns, strict=True))
    return common, std, bool((np.abs(delays - common) <= apart)[told].all()), joints


def _common(delays: Array, deviations: Array) -> tuple[float, float]:
    """Mean of the joints' delays and its deviation."""
    weights = 1.0 / deviations**2
    used = np.where(weights > 0.0, delays, 0.0)
    return float(weights @ used / weights.sum()), float(weights.sum() ** -0.5)


def _rounded_anew(p: Prepared, seed: int) -> Record:
    """The record with its smoothed positions rounded once more, at other places of the steps."""
    random, record = np.random.default_rng(seed), p.record
    q, motor = p.q.copy(), p.motor.copy()
    drives = drives_of(record.arm) if record.arm is not None else ()
    for k, step in enumerate(position_steps(record)):
        if step:
            place = step * random.uniform()
            q[:, k] = step * np.rint((q[:, k] + place) / step) - place
            motor[:, k] = drives[k].motor(q[:, k]) if drives else q[:, k]
    return replace(record, q=q, motor=motor)


class _Fit:
    """Records, and the columns (M, n, p) of their model away from rest."""

    def __init__(self, records: Sequence[Prepared], model: Model, evaluator: Evaluator) -> None:
        self.records, self.model, self.evaluator = records, model, evaluator
        self.n, self.p = records[0].n, len(model.grouping.base)
        self.moving = [r.moving for r in records]
        self.missing = np.zeros(self.n, dtype=bool)
        self.motions = [Motion(r.time, r.q, r.dq, r.ddq) for r in records]
        self._evaluate(np.zeros(self.p))

    def _evaluate(self, theta: Array) -> None:
        pairs = list(zip(self.records, self.motions, strict=True))
        self.full = [np.asarray(self.evaluator.regressor(self.model, m, theta)) for _, m in pairs]
        self.columns = [
            r.parallel(full * r.weights[:, :, None]) for r, full in zip(self.records, self.full, strict=True)
        ]

    def delays(self, *, free: bool = True) -> tuple[Array, Array]:
        """Delays of the joints (n,) and their deviations [samples], infinite for those that do not tell.

        free: whether these hold what free laws beside the model change.
        """
        first = self.records[0].record
        delays = np.full(self.n, first.hold / first.step)
        efforts = self._efforts(delays)
        if sum(int(m.sum()) for m in self.moving) < 3 * (self.p + self.n):
            return delays, np.full(self.n, np.inf)
        before = Regression(efforts, self.columns, self.moving).solve("wls")
        theta = before.theta
        self._evaluate(theta)
        told, deviations = np.ones(self.n, dtype=bool), np.full(self.n, np.inf)
        cutoff = self.records[0].settings.cutoff or 1.0 / first.step
        longest = max(LONGEST, TURNED / (cutoff * first.step))
        near, way = 0, np.zeros(self.n)  # steps that do not go on as far as they may; where the last one went
        for _ in range(2 * STEPS):
            columns = self._with_delays(theta)
            solution = Regression(efforts, columns, self.moving).solve("wls")
            theta, moved = solution.theta[: self.p], solution.theta[self.p :]
            told = solution.determined[self.p :] & np.isfinite(moved)
            deviations = np.sqrt(np.maximum(np.diag(solution.covariance)[self.p :], 0.0))
            delays = delays + np.where(told, np.clip(moved, -longest, longest), 0.0)
            settled = (np.abs(moved[told]) <= np.maximum(SETTLED, SETTLED * deviations[told])).all()
            if settled:
                break
            efforts = self._efforts(delays)
            near += not (told & (way * moved > longest)).any()
            way = np.sign(moved)
            if near == STEPS:
                break
        if not settled:
            told &= np.abs(moved) <= deviations
        self.missing = self._missing(solution.sigma, before.sigma)
        if free:
            deviations = np.hypot(deviations, self._beside_free_laws(efforts, columns, theta, solution.sigma))
        return delays, np.where(told & (deviations > 0.0), deviations, np.inf)

    def _missing(self, left: Array, without: Array) -> NDArray[np.bool_]:
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

    def _with_delays(self, theta: Array) -> list[Array]:
        """Columns (M, n, p + n) of each record: those of the model, and the slopes of its efforts."""
        columns = []
        for r, own, full in zip(self.records, self.columns, self.full, strict=True):
            slope = r.parallel(np.gradient(full @ theta, axis=0) * r.weights)
            more = np.zeros((len(slope), self.n, self.n))
            more[:, range(self.n), range(self.n)] = slope
            columns.append(np.concatenate([own, more], axis=2))
        return columns

    def _beside_free_laws(
        self, efforts: Sequence[Array], columns: Sequence[Array], theta: Array, sigma: Array
    ) -> Array:
        """Changes of the delays (n,) where each joint may have any law of its position, speed and load."""
        low = np.min([r.q.min(axis=0) for r in self.records], axis=0)
        high = np.max([r.q.max(axis=0) for r in self.records], axis=0)
        fast = np.max([np.abs(r.dq).max(axis=0) for r in self.records], axis=0)
        freer = []
        for r, own, full in zip(self.records, columns, self.full, strict=True):
            laws = _laws(
                (r.q - low) / np.maximum(high - low, 1e-300), r.dq / np.maximum(fast, 1e-300), full @ theta
            )
            count = laws.shape[2]
            more = np.zeros((len(own), self.n, self.n * count))
            for j in range(self.n):
                more[:, j, j * count : (j + 1) * count] = r.parallel(laws[:, j] * r.weights[:, j, None])
            freer.append(np.concatenate([own, more], axis=2))
        weighted = [x / sigma[:, None] for x in freer], [y / sigma for y in efforts]
        moved = Regression(weighted[1], weighted[0], self.moving).least_squares()
        return moved[self.p : self.p + self.n]

    def _efforts(self, delays: Array) -> list[Array]:
        """Efforts (M, n) at the positions' instants, where their samples lie `delays` samples after them."""
        found = []
        for r, motion in zip(self.records, self.motions, strict=True):
            assert r.record.input is not None
            given = np.column_stack(
                [
                    advanced(x[:, None], d, held=False)[:, 0]
                    for x, d in zip(r.record.input.T, delays, strict=True)
                ]
            )
            found.append(r.parallel(self.evaluator.ideal(self.model, motion, given) * r.weights))
        return found


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
