"""The step of an encoder's counts, as a log of few digits shows it."""

from __future__ import annotations

import numpy as np
import pytest

from modelgen.dataset.processing.rounding import mean_error, mean_error_power, resolution

T = np.arange(0.0, 24.0, 0.002)
ANGLE = 20.0 * np.sin(T) + 8.0 * np.sin(2.3 * T)
COUNT = 360.0 / 4096.0


@pytest.mark.parametrize("digits", [2, 3, 4, 6, 9])
@pytest.mark.parametrize("unit", [1.0, np.pi / 180.0])
def test_counts_are_seen_through_decimal_digits(digits: int, unit: float) -> None:
    logged = unit * np.round(COUNT * np.round(ANGLE / COUNT), digits)
    assert resolution(logged) == pytest.approx(unit * COUNT, rel=1e-4)


def test_counts_are_seen_in_single_precision() -> None:
    logged = (COUNT * np.round(ANGLE / COUNT)).astype(np.float32).astype(float)
    assert resolution(logged) == pytest.approx(COUNT, rel=1e-5)


@pytest.mark.parametrize("seed", range(5))
def test_what_has_no_counts_shows_none(seed: int) -> None:
    random = np.random.default_rng(seed)
    noisy = ANGLE + 1e-3 * random.standard_normal(len(T))
    assert resolution(ANGLE) is None
    assert resolution(noisy) is None
    assert resolution(ANGLE.astype(np.float32).astype(float)) is None
    assert resolution(np.array([float(f"{x:.4e}") for x in noisy])) is None  # digits that follow the size
    assert resolution(np.round(noisy, 5)) == pytest.approx(1e-5)


def test_few_readings_of_any_size_show_none() -> None:
    found = [resolution(np.random.default_rng(k).exponential(size=12).cumsum()) for k in range(500)]
    assert not any(found)


@pytest.mark.parametrize("noise", [0.06, 0.1, 0.2, 0.4])
def test_the_mean_of_rounding_errors_is_that_of_many_roundings(noise: float) -> None:
    random = np.random.default_rng(3)
    values, step = np.linspace(0.0, 1.0, 41)[:-1] + 0.0123, 0.25
    readings = values[:, None] + noise * step * random.normal(size=(1, 20_000))
    drawn = (step * np.rint(readings / step) - readings).mean(axis=1)
    assert mean_error(values, step, noise * step) == pytest.approx(drawn, abs=3e-3)
    many = np.arange(0.0, 1.0, 1e-4)
    power = np.mean(mean_error(many, step, noise * step) ** 2)
    assert mean_error_power(step, noise * step) == pytest.approx(power, rel=1e-3)


def test_without_noise_rounding_errors_are_uniform_over_a_step() -> None:
    """But for the jumps, which a few waves do not follow."""
    assert mean_error_power(0.25, 0.0) == pytest.approx(0.25**2 / 12.0, rel=0.1)
