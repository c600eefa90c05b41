"""Noise of one colour hides columns of the same colour: against draws of such noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from diagnosis_support import BARE, UNUSED, system_of
from numpy.random import Generator, default_rng
from scipy.signal import lfilter
from scipy.stats import chi2

from modelgen.diagnosis.equations.rows import Rows
from modelgen.diagnosis.evidence.noise import Autocorrelation, correlations
from modelgen.diagnosis.options.thresholds import EvidenceThresholds
from modelgen.numeric import Array

PERIOD, PERIODS = 500, 3
LONG = PERIOD * PERIODS
LIMITS = EvidenceThresholds()
LAGS = LIMITS.autocorrelation_lags
KEPT = 0.8  # from row to row, of the slow noise


def slow_noise(random: Generator, kept: float = KEPT) -> Array:
    """White, and slow of as much power."""
    drift = np.sqrt(1 - kept**2) * lfilter([1.0], [1.0, -kept], random.normal(size=LONG + 500))[500:]
    return np.asarray(drift + random.normal(size=LONG))


def wave(cycles: float, phase: float = 0.0) -> Array:
    """(N,), as often in every period."""
    return np.sin(2 * np.pi * cycles * np.arange(LONG) / PERIOD + phase)


def test_the_variance_of_a_sum_is_that_of_draws() -> None:
    """Of a slow and a fast column, with gaps where the joint rests."""
    moving = np.arange(LONG) % 250 > 40
    columns = np.column_stack([wave(2.0), wave(120.0, 0.3)])[moving]
    lags: Array = KEPT ** np.arange(LAGS, dtype=float)
    lags[0] = 2.0
    colour = Autocorrelation((lags / 2.0)[None], [moving[:, None]], [None], LIMITS)
    random = default_rng(1)
    sums = np.array([columns.T @ slow_noise(random)[moving] for _ in range(2000)]) / np.sqrt(2.0)
    np.testing.assert_allclose(np.diag(colour.variance(columns)), sums.var(axis=0), rtol=0.1)


def test_the_colour_is_found_between_periods() -> None:
    """Whatever repeats in every period has no part in it."""
    random = default_rng(2)
    residuals = [(slow_noise(random) + 5.0 * wave(3.0))[:, None] for _ in range(6)]
    flags = [np.ones((LONG, 1), dtype=bool)] * 6
    found = correlations(residuals, flags, [PERIOD] * 6, LIMITS)
    assert found is not None
    expected = 0.5 * KEPT ** np.arange(1, LAGS) * (1.0 - np.arange(1, LAGS) / LAGS)
    np.testing.assert_allclose(found[0, 1:], expected, atol=0.06)
    assert correlations(residuals, flags, [None] * 6, LIMITS) is None


def evidence(
    seed: int, cycles: float, size: float = 0.0, kept: tuple[float, ...] = (KEPT,), drift: bool = False
) -> list[float]:
    """Twice the log likelihood ratio of a wave, or a drift, that is there to this extent in two records, at
    the first of joints whose noise keeps so much from row to row: in the plain equations, and in them as if
    noise hid all columns alike.
    """
    random, n = default_rng([3, seed]), len(kept)
    rows, columns = [], []
    for k in range(2):
        own = np.linspace(-1.0, 1.0, LONG) if drift else wave(cycles, 0.5 * k)
        effort = np.stack([2.0 * wave(1.0) + slow_noise(random, kept=part) for part in kept], axis=1)
        effort[:, 0] += size * own
        table = np.zeros((LONG, n, n))
        table[:, range(n), range(n)] = wave(1.0)[:, None]
        rows.append(Rows(UNUSED, effort, table, np.ones((LONG, n), dtype=bool), BARE))
        columns.append(np.zeros((LONG, n, 1)))
        columns[-1][:, 0, 0] = own
    plain = system_of(rows, [r.columns for r in rows], [PERIOD] * 2).plain
    found = [plain.gain(columns, passing=drift)]
    plain.colour = None
    found.append(plain.gain(columns, passing=drift))
    return [x.delta_bic + float(np.log(plain.counts.sum())) for x in found if x is not None]


@pytest.mark.parametrize("cycles", [2.0, 6.0])
def test_evidence_of_what_is_not_there_is_that_of_chance(cycles: float) -> None:
    """A likelihood ratio: above the quantile of chi-square as often as that says. As if noise hid all columns
    alike, four times as often.
    """
    table = np.array([evidence(k, cycles) for k in range(400)])
    often = (table > chi2.ppf(0.95, 1)).mean(axis=0)
    assert 0.02 < often[0] < 0.09
    assert often[1] > 0.12


@pytest.mark.parametrize(
    ("kept", "drift"),
    [((0.95, 0.0, 0.0), False), ((0.0, 0.95, 0.95), False), ((0.0, 0.95, 0.95), True), ((0.95,), True)],
)
def test_every_joint_has_a_colour_of_its_own(kept: tuple[float, ...], drift: bool) -> None:
    """Slow noise at one, white at others, and the other way round; what repeats and what does not."""
    found = np.array([evidence(k, 2.0, 0.0, kept, drift)[0] for k in range(300)])
    assert 0.6 < found.mean() < 1.7  # of chi-square 1
    assert (found > chi2.ppf(0.95, 1)).mean() < 0.11


def test_fast_columns_lose_nothing() -> None:
    own, alike = evidence(1, 120.0, 0.5)
    assert own == alike > 20.0


def test_what_passes_is_not_the_noise_that_hides_it() -> None:
    """A drift over the whole record is among what differs between periods, unless it is taken off."""
    drift = np.linspace(-1.0, 1.0, LONG)
    rows = [
        Rows(
            UNUSED, (3.0 * drift + slow_noise(default_rng(k)))[:, None], wave(1.0)[:, None, None], flags, BARE
        )
        for k, flags in enumerate([np.ones((LONG, 1), dtype=bool)] * 2)
    ]
    plain = system_of(rows, [r.columns for r in rows], [PERIOD] * 2).plain
    hidden, seen = (plain.gain([drift[:, None, None]] * 2, passing=passing) for passing in (False, True))
    assert hidden is not None
    assert seen is not None
    assert hidden.delta_bic < 0.5 * seen.delta_bic
    without = [replace(r, effort=r.effort - 3.0 * drift[:, None]) for r in rows]
    clean = system_of(without, [r.columns for r in rows], [PERIOD] * 2).plain.colour
    found = plain.colour
    assert clean is not None
    assert found is not None
    left = plain.left - plain.stacked([drift[:, None, None]] * 2)[:, 0] * seen.values[0]
    columns = plain.stacked([wave(6.0)[:, None, None]] * 2)
    np.testing.assert_allclose(found.of(left).variance(columns), clean.variance(columns), rtol=0.1)


def test_noise_of_unknown_colour_asks_for_more() -> None:
    rows = [
        Rows(UNUSED, slow_noise(default_rng(k))[:, None], wave(1.0)[:, None, None], flags, BARE)
        for k, flags in enumerate([np.ones((LONG, 1), dtype=bool)] * 2)
    ]
    columns = [r.columns for r in rows]
    assert system_of(rows, columns, [PERIOD] * 2).price == 1.0
    assert system_of(rows, columns, [None, None]).price > 1.0
    once = np.arange(LONG)[:, None] < PERIOD  # moves in the first period alone: nothing repeats
    still = [replace(r, moving=once) for r in rows]
    assert system_of(still, columns, [PERIOD] * 2).price > 1.0
