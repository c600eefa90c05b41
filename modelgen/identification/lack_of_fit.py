"""What an identified model leaves of the training records' efforts alike in every period of the motion.

Noise differs from period to period. What does not is the model's own error, and no deviation that is made of
noise holds it (Draper and Smith 1998, 1.5). Readings in coarse steps repeat too, and that is no error of the
model: their roundings are drawn once more, at other places of the steps, and count as noise. The filter of
positions moves the instants at which a joint that sticks sets off, and friction's sign with these, alike in
every period: what is found has to be found with as light a filter as the steps allow too.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy import special

from modelgen.dataset import Prepared, prepare
from modelgen.dataset.processing.content import quiet_speeds
from modelgen.dataset.processing.periods import by_phase, folded
from modelgen.dataset.processing.rounding import effort_steps, position_steps
from modelgen.evaluation import Evaluator
from modelgen.functions import Model
from modelgen.identification.objects import LackOfFit
from modelgen.identification.rounded_efforts import COARSE, ideal, rounding
from modelgen.identification.rounded_positions import prepared_anew
from modelgen.identification.validation import regression_of, rows_in_period
from modelgen.numeric import Array
from modelgen.regression.least_squares import Regression

LIMIT = 3.0  # from which on deviations that held it would be 1.7 times as large, or more
SIGNIFICANCE = 0.001  # of short records, which leave so much by chance
FEWEST = 20  # rows that differ between periods
DRAWS = 2  # of roundings: a budget, more tell the same with less scatter


@dataclass
class _Sums:
    """Of one joint: squares between periods and within, and how many rows they are of."""

    between: float = 0.0
    within: float = 0.0
    free_between: float = 0.0
    free_within: float = 0.0
    rows: int = 0

    @property
    def repeats(self) -> float:
        """Mean square between periods, of so many rows that it is noise's own where nothing but noise is."""
        return self.between / max(self.free_between, 1.0)

    def add(self, errors: Array, moving: NDArray[np.bool_], rows: int) -> None:
        """A record's errors (M,), with so many rows in a period."""
        between, within, count = by_phase(folded(np.where(moving, errors, np.nan), rows))
        self.between += float(between.sum())
        self.within += float(within.sum())
        self.rows += int(count.sum())
        self.free_between += float((count > 0).sum())
        self.free_within += float(np.maximum(count - 1, 0).sum())


def lack_of_fit(
    train: Sequence[Prepared],
    model: Model,
    evaluator: Evaluator,
    theta: Array,
    periods: Sequence[int | None],
    added: Sequence[Array] | None = None,
) -> LackOfFit | None:
    """Test the model with base parameters theta (p,) on its training records; None where nothing repeats.

    periods: rows in a period of each record, None where it does not repeat. added: base parameters (p,) that
    each record has in addition, of a payload.
    """
    if all(rows is None for rows in periods):
        return None
    found = _found(train, model, evaluator, theta, periods, added)
    if found is None or not len(found.found):
        return found
    sharp = [_sharp(p) for p in train]
    own = regression_of(evaluator, model, sharp, theta, added).least_squares()
    return _found(sharp, model, evaluator, own, periods, added)


def beside_noise_in_motion(
    test: Sequence[Prepared], model: Model, evaluator: Evaluator, theta: Array
) -> Array | None:
    """RMS (n,) of the errors of the base parameters theta (p,) over that of noise, on records that were not
    fitted; None where nothing repeats, nan where a joint has no noise.

    Rests and turns are left out before the filter, as in a fit: it carries on what holds a joint there.
    """
    sharp = [_sharp(p) for p in test]
    periods = [rows_in_period(p) for p in sharp]
    if all(rows is None for rows in periods):
        return None
    regression = regression_of(evaluator, model, sharp, theta)
    sums = _sums(regression.residuals(theta), regression, periods)
    noise = [s.within / s.free_within if s.free_within else 0.0 for s in sums]
    whole = [(s.between + s.within) / max(s.rows, 1) for s in sums]
    return np.sqrt([e / v if v > 0.0 else np.nan for e, v in zip(whole, noise, strict=True)])


def _sharp(p: Prepared) -> Prepared:
    """The record with its positions filtered as little as their steps allow."""
    own, limits = p.settings.position_cutoff, p.settings.thresholds
    quiet = quiet_speeds(p.record, limits)
    light = 0.0 if quiet * p.record.step > limits.max_position_cutoff or not own else max(own, quiet)
    return replace(prepare(p.record, replace(p.settings, position_cutoff=light)), before=p.before)


def _found(
    train: Sequence[Prepared],
    model: Model,
    evaluator: Evaluator,
    theta: Array,
    periods: Sequence[int | None],
    added: Sequence[Array] | None,
) -> LackOfFit | None:
    """The test on records as they are prepared; arguments as there."""
    regression = regression_of(evaluator, model, train, theta, added)
    own = _sums(regression.residuals(theta), regression, periods)
    share = 1.0 if regression.white is None else 1.0 / (1.0 + 2.0 * float((regression.white[1:] ** 2).sum()))
    found = _tested(own, np.zeros(len(own)), share)
    if found is None or not len(found.found):
        return found
    rounded = np.zeros(len(own))
    for drawn in _roundings(train, model, evaluator, theta):
        every = [[s.repeats for s in _sums(x, regression, periods)] for x in drawn]
        rounded += np.mean(every, axis=0)
    return _tested(own, rounded, share)


def _tested(sums: Sequence[_Sums], rounded: Array, share: float) -> LackOfFit | None:
    """rounded: mean squares (n,) of what rounding leaves between periods, by DRAWS of it. share: of the rows,
    that are independent.

    How well noise and rounding together are known is counted by Satterthwaite (1946).
    """
    statistic, threshold = np.full(len(sums), np.nan), np.full(len(sums), np.nan)
    for j, s in enumerate(sums):
        if s.free_within < FEWEST or s.within <= 0.0:
            continue
        noise, drawn = s.within / s.free_within, float(rounded[j])
        free = (noise + drawn) ** 2 / (noise**2 / s.free_within + drawn**2 / (DRAWS * s.free_between))
        chance = special.fdtri(share * s.free_between, share * free, 1.0 - SIGNIFICANCE / len(sums))
        statistic[j] = s.repeats / (noise + drawn)
        threshold[j] = max(LIMIT, float(chance))
    return LackOfFit(statistic, threshold) if np.isfinite(statistic).any() else None


def _roundings(
    train: Sequence[Prepared], model: Model, evaluator: Evaluator, theta: Array
) -> Iterator[list[list[Array]]]:
    """Draws of the errors (M, n) of each record's rows that rounding of its positions makes, then of its
    efforts.
    """
    if any(position_steps(p.record).any() for p in train):
        # the log's own rounding is in each of them
        drawn = [[prepared_anew(p, seed) for p in train] for seed in range(DRAWS + 1)]
        columns = [regression_of(evaluator, model, x, theta).columns for x in drawn]
        pairs = pairwise(columns)
        yield [[(x - y) @ theta / np.sqrt(2.0) for x, y in zip(*pair, strict=True)] for pair in pairs]
    steps = [effort_steps(p.record, COARSE) for p in train]
    if any(x.any() for x in steps):
        random, inputs = np.random.default_rng(0), [ideal(p, model, evaluator, theta) for p in train]
        asked = list(zip(train, inputs, steps, strict=True))
        yield [[rounding(p, y, step, random) for p, y, step in asked] for _ in range(DRAWS)]


def _sums(errors: Sequence[Array], regression: Regression, periods: Sequence[int | None]) -> list[_Sums]:
    """Of every joint, of errors (M, n) of each record."""
    sums = [_Sums() for _ in range(errors[0].shape[1])]
    for e, moving, rows in zip(errors, regression.moving, periods, strict=True):
        for j, s in enumerate(sums if rows is not None else ()):
            assert rows is not None
            s.add(e[:, j], moving[:, j], rows)
    return sums
