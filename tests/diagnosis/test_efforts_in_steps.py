"""Efforts that are logged in coarse steps: what rounding repeats in every period is no lack of fit."""

from __future__ import annotations

import numpy as np
import pytest
from geared_link import LINK, PERIOD, sines

import modelgen as mg
from modelgen.description import loads

Table = dict[str, np.ndarray]


@pytest.fixture(scope="module")
def arm() -> mg.Arm:
    return loads(LINK.description())["one"]


def log(seed: int, step: float, noise: float, stribeck: float, rate: float = 200.0) -> Table:
    """Three periods. stribeck: more friction at low speed [A]. rate: samples per second [Hz]."""
    random = np.random.default_rng([seed, 5])
    t = np.arange(int(3 * PERIOD * rate)) / rate
    q, dq, ddq = sines(t, random.uniform(0.0, 6.28, 4))
    effort = LINK.currents(q, dq, ddq) + stribeck * np.sign(dq) * np.exp(-((dq / 0.15) ** 2))
    effort += noise * random.normal(size=len(t))
    position = LINK.ratio * q + 1e-4 * random.normal(size=len(t))
    return {"t": t, "qm1": position, "i1": step * np.rint(effort / step)}


def diagnosis(
    arm: mg.Arm, seed: int, step: float, noise: float, stribeck: float = 0.0, rate: float = 200.0
) -> mg.Diagnosis:
    logs = [log(10 * seed + k, step, noise, stribeck, rate) for k in range(3)]
    return mg.diagnose(arm, logs[:2], logs[2], experiment=False)


@pytest.mark.parametrize(("step", "noise"), [(0.1, 0.01), (0.05, 0.002)])
@pytest.mark.parametrize("seed", [0, 1])
def test_steps_that_hide_what_may_be_there_are_said(
    step: float, noise: float, seed: int, arm: mg.Arm
) -> None:
    found = diagnosis(arm, seed, step, noise)
    assert (found.verdict, found.causes, found.suspects) == ("cannot_tell", (), ())
    assert "the efforts are logged in steps that are too coarse" in found.to_json()["reason"]
    assert (
        "finer steps, or a motion that differs from period to period, can tell" in found.to_json()["reason"]
    )


def test_noise_of_a_third_of_a_step_makes_noise_of_its_rounding(arm: mg.Arm) -> None:
    assert diagnosis(arm, 0, 0.1, 0.03).verdict == "nothing_missing"


def test_rows_need_be_no_whole_numbers_of_samples(arm: mg.Arm) -> None:
    """Of a period with a prime number of samples."""
    found = diagnosis(arm, 0, 0.1, 0.01, rate=1619.0 / PERIOD)
    assert (found.verdict, found.causes, found.suspects) == ("cannot_tell", (), ())


@pytest.mark.parametrize("noise", [0.01, 0.03])
def test_what_is_larger_than_the_steps_is_named(noise: float, arm: mg.Arm) -> None:
    found = diagnosis(arm, 0, 0.1, noise, stribeck=0.2)
    assert [(c.effect, c.joint) for c in found.causes] == [("stribeck_friction", 1)]
    values = found.to_json()["causes"][0]["parameters"]
    assert values["magnitude"]["value"] == pytest.approx(0.2 * LINK.constant, rel=0.1)
    assert values["velocity"]["value"] == pytest.approx(0.15 * LINK.ratio, rel=0.1)
