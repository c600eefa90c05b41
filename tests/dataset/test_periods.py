"""Periods that are given must be those of the motion."""

import numpy as np
import pytest

from modelgen.dataset import Record
from modelgen.dataset.processing.periods import period_of
from modelgen.errors import InputError

STEP, PERIOD = 0.01, 4.0


def record(noise: float) -> Record:
    """A joint that repeats every 4 s, and one under its brake that trembles by a count."""
    random = np.random.default_rng(2)
    t = np.arange(1500) * STEP
    swing = np.sin(2 * np.pi * t / PERIOD) + 0.4 * np.cos(4 * np.pi * t / PERIOD)
    braked = 1e-4 * random.integers(0, 2, len(t))
    q = np.column_stack([swing + random.normal(scale=max(noise, 1e-9), size=len(t)), braked])
    return Record("log.csv", t, q, q)


@pytest.mark.parametrize("noise", [0.0, 0.1])
def test_the_period_of_the_motion_is_taken_as_it_is_given(noise: float) -> None:
    """Noise that hides it from the search does not matter, nor does a joint that only trembles."""
    assert period_of(record(noise), None) is None
    assert period_of(record(noise), PERIOD) == round(PERIOD / STEP)


@pytest.mark.parametrize("given", [3.0, 1.0, 5.5])
def test_another_period_is_refused(given: float) -> None:
    with pytest.raises(InputError, match="does not repeat after"):
        period_of(record(0.0), given)


def test_a_record_too_short_for_two_has_none() -> None:
    assert period_of(record(0.0), 2 * PERIOD) is None
