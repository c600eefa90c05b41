"""Waves over a motor's position are found where records lie far apart."""

import numpy as np
import pytest

from modelgen.diagnosis.candidates.periodogram import waves
from modelgen.diagnosis.options.thresholds import USUAL


@pytest.mark.parametrize("wave", [0.7, 1.0, 1.013, 2.4])
@pytest.mark.parametrize("apart", [0.0, 150.0])
def test_the_first_wave_is_the_true_one(wave: float, apart: float) -> None:
    """Two records 150 rad apart make fringes of 0.042 rad^-1, which were taken one for the other."""
    random, t = np.random.default_rng(3), np.arange(800) / 800
    first = 18.0 * np.sin(2 * np.pi * t) - apart
    second = 12.5 * np.sin(2 * np.pi * t + 1.0) + 4.0 * np.sin(6 * np.pi * t)
    position = np.concatenate([first, second])
    speed = np.gradient(position)
    residual = np.sin(wave * position + 0.4) + 0.1 * random.normal(size=len(position))
    found = waves(residual, position, speed, 0.25, USUAL.candidates)
    assert found[0] == pytest.approx(wave, abs=0.25 * np.pi / np.ptp(position))
