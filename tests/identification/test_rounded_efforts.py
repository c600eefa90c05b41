"""Deviations hold where efforts have coarse steps and change slowly; noise of a step's size needs no more."""

from __future__ import annotations

import numpy as np
import pytest
from geared_link import GearedLink, sines

import modelgen as mg
from modelgen.description import loads
from modelgen.effects import known_effects

# A pendulum whose current is a few amperes, and its weight most of it.
LINK = GearedLink(mass=4.0, moment=1.0, inertia=0.45, ratio=50.0, constant=0.1, viscous=2.0e-4, dry=0.02)
ARM = loads(LINK.description(), "arms.yaml", known_effects())["one"]
RATE, SECONDS = 200.0, 10.0
Table = dict[str, np.ndarray]


def log(seed: int, step: float, noise: float) -> Table:
    """A motion of five harmonics about the horizontal."""
    random, t = np.random.default_rng(seed), np.arange(int(RATE * SECONDS)) / RATE
    w = 2 * np.pi * np.arange(1, 6) / SECONDS
    size, phase = random.uniform(0.1, 0.35, 5) / np.sqrt(np.arange(1, 6)), random.uniform(0, 6.28, 5)
    q, dq, ddq = sines(t, phase, size, w)
    current = LINK.currents(q, dq, ddq) + noise * random.normal(size=len(t))
    return {"t": t, "q1": q, "i1": step * np.rint(current / step) if step else current}


def errors(step: float, noise: float, seeds: range) -> np.ndarray:
    """Errors of the parameters in their deviations, by log."""
    found = []
    for seed in seeds:
        result = mg.identify(ARM, log(seed, step, noise), log(seed + 1000, step, noise))
        found.append([(e.value - LINK.parameters[name]) / e.std for name, e in result.parameters.items()])
    return np.array(found)


@pytest.mark.parametrize("step", [0.25, 0.5])
def test_deviations_hold_what_rounding_does(step: float) -> None:
    apart = errors(step, 0.01, range(12))
    assert (np.abs(apart) < 1.96).mean() >= 0.9
    assert np.abs(apart).max() < 4.5


@pytest.mark.parametrize(("step", "top"), [(0.5, 2.0), (0.5, np.inf), (0.8, np.inf)])
def test_deviations_hold_where_few_readings_do_not_show_whether_they_are_cut_off(
    step: float, top: float
) -> None:
    """Two or three readings in steps as large as what the efforts do, be they cut off at `top` [A] or not."""
    apart = []
    for seed in range(10):
        logs = [log(seed + more, step, 0.01) for more in (0, 1000)]
        for table in logs:
            table["i1"] = np.minimum(table["i1"], top)
        assert len(np.unique(logs[0]["i1"])) <= 6
        if min(np.sort(np.unique(x["i1"], return_counts=True)[1])[:-1].sum() for x in logs) < 100:
            continue  # hardly ever another reading than one
        found = mg.identify(ARM, *logs)
        apart += [(e.value - LINK.parameters[name]) / e.std for name, e in found.parameters.items()]
    assert len(apart) >= 20
    assert (np.abs(apart) < 1.96).mean() >= 0.85
    assert np.abs(apart).max() < 5.0


def test_fine_efforts_have_the_deviations_of_their_noise() -> None:
    logs = [[log(seed, step, 0.02) for seed in (1, 1001)] for step in (0.0, 0.001)]
    plain, fine = ([e.std for e in mg.identify(ARM, *x).parameters.values()] for x in logs)
    assert fine == pytest.approx(plain, rel=0.02)


def test_noise_of_a_step_makes_rounding_noise() -> None:
    """Then deviations are those of both noises, and no more."""
    logs = [[log(seed, step, 0.3) for seed in (1, 1001)] for step in (0.0, 0.3)]
    plain, rounded = (np.array([e.std for e in mg.identify(ARM, *x).parameters.values()]) for x in logs)
    both = np.sqrt(1.0 + 1.0 / 12.0)
    assert rounded == pytest.approx(both * plain, rel=0.3)
