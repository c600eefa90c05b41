"""What repeats in a short part of the period, in noise of which all is known: no arm, no filter."""

from dataclasses import replace

import numpy as np
import pytest
from diagnosis_support import BARE, UNUSED, system_of
from numpy.random import Generator, default_rng
from scipy.signal import lfilter

from modelgen.diagnosis.adequacy.lack_of_fit import PART, WHOLE, lack_of_fit, ratios
from modelgen.diagnosis.equations.rows import Rows
from modelgen.diagnosis.evidence.system import System
from modelgen.numeric import Array

PERIOD, PERIODS = 480, 3
BUMP = slice(210, 240)  # a sixteenth of the period


def record(random: Generator, repeats: Array, colour: float = 0.0) -> Rows:
    """One joint; repeats: (PERIOD,), what every period has besides noise of unit size."""
    noise = lfilter([np.sqrt(1 - colour**2)], [1.0, -colour], random.normal(size=PERIOD * PERIODS + 200))[
        200:
    ]
    phase = 2 * np.pi * np.arange(PERIOD) / PERIOD
    shapes = [np.sin(k * phase) for k in range(1, 6)]
    columns = np.column_stack([np.tile(s, PERIODS) for s in shapes])
    effort = columns.sum(axis=1) + np.tile(repeats, PERIODS) + noise
    flags = np.ones((len(effort), 1), dtype=bool)
    return Rows(UNUSED, effort[:, None], columns[:, None, :], flags, BARE)


def system(seed: int, repeats: Array, colour: float = 0.0, records: int = 2) -> System:
    """Of one arm, two records or more."""
    random = default_rng([3, seed])
    rows = [record(random, repeats, colour) for _ in range(records)]
    return system_of(rows, periods=[PERIOD] * records)


def bump(size: float) -> Array:
    """A contact in one place of the period."""
    found = np.zeros(PERIOD)
    found[BUMP] = size * (-1.0) ** np.arange(BUMP.stop - BUMP.start)  # of a form that the columns lack
    return found


def test_a_short_contact_is_found_and_placed() -> None:
    """More clearly than by all rows together."""
    for k in range(10):
        made = system(k, bump(1.3))
        fit, by_kind = lack_of_fit(made), ratios(made)
        assert fit is not None
        assert fit.found
        assert fit.worst.kind == PART
        assert fit.worst.begin < BUMP.stop
        assert fit.worst.end > BUMP.start
        assert by_kind[PART] > 1.2 * by_kind[WHOLE]


def test_a_little_in_every_phase_is_found_in_all_rows_together() -> None:
    """Where no part shows it as clearly. Means over periods have the noise's variance over their number."""
    size, found = 0.5, []
    for k in range(10):
        made = system(k, size * default_rng([5, k]).normal(size=PERIOD))
        fit, by_kind = lack_of_fit(made), ratios(made)
        assert fit is not None
        assert fit.found
        assert fit.worst.kind == WHOLE
        assert by_kind[WHOLE] > 1.2 * by_kind[PART]
        found.append(fit.by_joint[0])
    assert np.mean(found) == pytest.approx(1.0 + PERIODS * size**2, rel=0.1)


@pytest.mark.parametrize("colour", [0.0, 0.7])
def test_noise_alone_is_not_found(colour: float) -> None:
    """At a nominal 0.1 % for all tests of a kind together, not once in sixty."""
    found = [ratios(system(k, np.zeros(PERIOD), colour)) for k in range(60)]
    assert max(r[PART] for r in found) < 1.0
    assert max(r[WHOLE] for r in found) < 1.0


def test_noise_alone_is_not_found_in_many_records() -> None:
    """Whose quantile of F comes near one: the threshold stays above it."""
    for seed in range(20):
        fit = lack_of_fit(system(seed, np.zeros(PERIOD), 0.7, records=24))
        assert fit is not None
        assert fit.threshold > 1.0
        assert not fit.found


def uneven(kind: str, random: Generator) -> Array:
    """What noise has more than elsewhere (2, PERIOD * PERIODS) at some rows of two records."""
    more = random.normal(size=(2, PERIOD * PERIODS))
    phase = np.arange(PERIOD * PERIODS) % PERIOD
    if kind == "outliers":  # one reading in 300
        return 30.0 * more * (random.random(more.shape) < 1 / 300)
    if kind == "in a stretch of the period":
        return 4.0 * more * ((phase > 300) & (phase < 360))
    return 3.0 * more * np.array([[0.0], [1.0]])


@pytest.mark.parametrize("kind", ["outliers", "in a stretch of the period", "in one record"])
def test_noise_that_is_larger_in_places_is_no_lack_of_fit(kind: str) -> None:
    """What repeats beside it is found as ever."""
    found = 0
    for k in range(20):
        random = default_rng([6, k])
        for repeats in (np.zeros(PERIOD), bump(6.0)):
            made = system(k, repeats)
            rows = [
                replace(r, effort=r.effort + more[:, None])
                for r, more in zip(made.rows, uneven(kind, random), strict=True)
            ]
            fit = lack_of_fit(system_of(rows, periods=made.periods))
            assert fit is not None
            if repeats.any():
                assert fit.found
                assert fit.worst.kind == PART
                assert fit.worst.begin < BUMP.stop
                assert fit.worst.end > BUMP.start
            else:
                found += fit.found
    assert found <= 2


def test_errors_of_the_positions_that_repeat_are_no_lack_of_fit() -> None:
    """Counts round the same motion alike: as large as the noise, they are found unless told of."""
    for seed in range(10):
        errors = default_rng([4, seed]).normal(size=PERIOD)
        made = system(seed, errors)
        found = lack_of_fit(made)
        assert found is not None
        assert found.found
        told = [replace(r, repeated=np.tile(errors, PERIODS)[:, None]) for r in made.rows]
        fit = lack_of_fit(system_of(told, periods=made.periods))
        assert fit is not None
        assert not fit.found
