"""The step of an encoder's counts, as a log of few digits shows it."""

from __future__ import annotations

import numpy as np
import pytest

from modelgen.dataset.processing.rounding import resolution

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
