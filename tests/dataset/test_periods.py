"""Periods of any length: found to a part of a sample, and put on rows of the same phases."""

import numpy as np
import pytest

from modelgen.dataset import Record
from modelgen.dataset.processing.periods import period_of, repetition, rows_in, with_whole_rows
from modelgen.dataset.processing.prepare import kept_rows
from modelgen.dataset.processing.settings import Settings, choose
from modelgen.dataset.processing.splitting import split
from modelgen.errors import InputError

SECONDS = 40.0


def moving(period: float, rate: float, noise: float, seed: int) -> Record:
    """Two joints on a Fourier series of five harmonics."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, SECONDS, 1 / rate)
    phase = 2 * np.pi * np.multiply.outer(t, 1 + np.arange(5)) / period
    q = np.cos(phase) @ rng.uniform(-0.4, 0.4, (5, 2)) + np.sin(phase) @ rng.uniform(-0.4, 0.4, (5, 2))
    read = q + noise * rng.normal(size=q.shape)
    return Record("run", t, read, read)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize(("period", "rate"), [(40 / 3, 100.0), (6.283185, 250.0), (9.983, 100.0)])
def test_a_period_between_samples_is_found_to_a_hundredth_of_one(
    period: float, rate: float, seed: int
) -> None:
    found = period_of(moving(period, rate, 1e-4, seed), None)
    assert found == pytest.approx(period * rate, abs=0.02)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("noise", [0.0, 1e-4, 1e-2])
def test_a_whole_number_of_samples_stays_one(noise: float, seed: int) -> None:
    assert period_of(moving(10.0, 100.0, noise, seed), None) == pytest.approx(
        1000, abs=2 if noise > 1e-3 else 0
    )


@pytest.mark.parametrize("period", [1333 + 1 / 3, 1333.0, 997.0, 1000.0])
def test_rows_of_two_periods_have_the_same_phase(period: float) -> None:
    record = moving(period / 100.0, 100.0, 0.0, 1)
    chosen = with_whole_rows(choose(record, Settings(cutoff=2.0)), [period_of(record, None)])
    rows = rows_in(period_of(record, None), chosen)
    assert rows is not None
    kept = kept_rows(record, chosen)
    assert np.abs(kept[rows:] - kept[:-rows] - period).max() <= 1.0
    assert abs(np.mean(kept[rows:] - kept[:-rows]) - period) < 0.1
    assert chosen.factor / 2 < chosen.stride <= chosen.factor


@pytest.mark.parametrize("count", [62, 120, 229, 361])
def test_a_motion_slower_than_the_record_has_no_period(count: int) -> None:
    t = np.arange(count) / 60.0
    q = 0.7 * np.cos(0.8 * t)[:, None]
    assert period_of(Record("run", t, q, q), None) is None


def sticking(seed: int, into: float = 0.0) -> Record:
    """Three periods of 10 s; the second joint comes later in each. into: [rad] by which the first joint
    is off at the start, for half a second.
    """
    record = moving(10.0, 100.0, 1e-4, seed).part(0, 3000)
    t, q = record.t, record.q.copy()
    q[:, 1] = np.interp(t - 0.04 * np.floor(t / 10.0), t, q[:, 1])
    q[:, 0] += into * np.exp(-t / 0.1)
    return Record("run", t, q, q)


@pytest.mark.parametrize("seed", range(4))
def test_a_joint_that_sticks_elsewhere_does_not_say_when_the_others_repeat(seed: int) -> None:
    assert period_of(sticking(seed), None) == pytest.approx(1000, abs=1)


@pytest.mark.parametrize("seed", range(2))
def test_what_is_given_and_found_needs_no_way_into_the_motion(seed: int) -> None:
    record = sticking(seed, into=0.05)
    assert repetition(record, 10.0) == (0, 1000)
    one, two = split(record, 10.0)
    assert (len(one.t), len(two.t)) == (2000, 1000)


def test_a_last_period_may_lack_a_little() -> None:
    parts = split(moving(10.0, 100.0, 1e-4, 0).part(0, 2980))
    assert [len(x.t) for x in parts] == [2000, 980]


def test_a_period_that_the_record_contradicts_is_refused() -> None:
    record = moving(10.0, 100.0, 1e-4, 0)
    with pytest.raises(
        InputError, match=r"--period: run repeats after 10 s, not nearly as well after 9\.9 s"
    ):
        period_of(record, 9.9)
    assert period_of(record, 20.0) == 2000
