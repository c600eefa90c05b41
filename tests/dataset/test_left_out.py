"""What is left out of a record before it is filtered leaves the rest as it was."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import signal

from modelgen.dataset import Record, Settings, prepare

RATE = 200.0
SETTINGS = Settings(cutoff=8.0, rest_gate=0.01)


def recorded(error: np.ndarray | float = 0.0) -> Record:
    """A joint that swings once a second, with errors (N,) of its position [rad]."""
    t = np.arange(0.0, 60.0, 1 / RATE)
    q = (np.cos(2 * np.pi * t) + error)[:, None]
    return Record("a", t, q, q, input=np.zeros(q.shape), effort_unit=("N m",))


def noise() -> np.ndarray:
    """Errors (N,) whose accelerations, up to the positions' cut-off, are most of what shows."""
    return np.random.default_rng(5).normal(0.0, 3e-3, int(60 * RATE))


def holes(count: int) -> np.ndarray:
    """Flags (N, 1) without two samples at each of the 120 instants at which the joint turns back."""
    t = np.arange(count) / RATE
    return np.asarray(np.abs((2 * t + 0.5) % 1 - 0.5) * RATE / 2 > 1.1)[:, None]


def test_less_noise_of_accelerations_comes_down_through_what_is_left_out() -> None:
    """Columns of noise up to the positions' cut-off: by sharp edges holes bring it into the band, as much as
    a periodogram of the product says; weights leave less than half of that.
    """
    clean, noisy = prepare(recorded(), SETTINGS), prepare(recorded(noise()), SETTINGS)
    error = noisy.ddq - clean.ddq
    flags = holes(len(error))
    inside = slice(5, -5)
    power = {
        name: float(np.mean(clean.parallel(error * weights)[inside] ** 2))
        for name, weights in (("none", 1.0), ("sharp", flags), ("weighted", noisy.weighted(flags)))
    }
    f, density = signal.welch((error * flags)[:, 0], RATE, nperseg=2000)
    response = 1 / (1 + (np.tan(np.pi * f / RATE) / np.tan(np.pi * 8.0 / RATE)) ** 8) ** 2
    assert power["sharp"] == pytest.approx(float(np.sum(density * response) * (f[1] - f[0])), rel=0.2)
    assert power["sharp"] > 3.0 * power["none"]
    assert power["weighted"] < 0.5 * power["sharp"]


def test_weights_are_nothing_where_samples_are_left_out_and_one_elsewhere() -> None:
    prepared = prepare(recorded(noise()), SETTINGS)
    flags = holes(len(prepared.time))
    flags[3:6] = flags[-2:] = False
    weights = prepared.weighted(flags)
    assert (weights[~flags] == 0.0).all()
    assert weights.min() >= 0.0
    assert weights.max() <= 1.0 + 1e-12
    away = np.convolve(~flags[:, 0], np.ones(13), mode="same") == 0  # the noise's period has 5.6 samples
    assert away.any()
    assert weights[away] == pytest.approx(1.0, abs=1e-12)
    assert (prepared.weighted(np.ones_like(flags)) == 1.0).all()
    assert (replace(prepared, awake=flags).weights == weights).all()


def test_edges_are_sharp_where_there_is_little_noise() -> None:
    prepared = prepare(recorded(0.1 * noise()), SETTINGS)
    flags = holes(len(prepared.time))
    assert np.array_equal(prepared.weighted(flags), flags)
