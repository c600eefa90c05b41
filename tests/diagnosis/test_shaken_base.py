"""A base that shakes is no delay: the controller answers it, so that the current seems to come late there."""

from __future__ import annotations

import numpy as np
import pytest
from geared_link import LINK

import modelgen as mg
from modelgen.description import loads

ARM = loads(LINK.description(values=False))["one"]
Table = dict[str, np.ndarray]
STEP = 1e-3  # s, of the simulation; every fourth is logged
WAVES = 2 * np.pi / 8.0 * np.array([1.0, 2.0, 3.0, 5.0])


def log(seed: int, shaken: float) -> Table:
    """Four periods of 8 s of the link under a PD controller. shaken: by so much at 9.3 Hz [m/s^2]."""
    random = np.random.default_rng([65, seed])
    phase, size = random.uniform(0, 2 * np.pi, 4), 0.25 / np.arange(1, 5)
    parts = LINK.parameters
    t = np.arange(0.0, 32.0, STEP)
    base = shaken * np.sin(2 * np.pi * 9.3 * t + random.uniform(0, 2 * np.pi)) / 9.81
    angle = WAVES * t[:, None] + phase
    wanted = np.array([np.sin(angle) @ size, np.cos(angle) @ (size * WAVES)]).T
    q, dq = wanted[0]
    rows = np.zeros((len(t), 2))
    inertia, weight = parts["ZZ1"], parts["MX1"] * 9.81
    for k in range(len(t)):
        torque = 60.0 * (wanted[k, 0] - q) + 5.0 * (wanted[k, 1] - dq)
        rows[k] = q, torque
        dry = LINK.ratio * (parts["FV1"] * LINK.ratio * dq + parts["FC1"] * np.tanh(dq / 1e-3))
        ddq = (torque - dry - weight * (1.0 + base[k]) * np.cos(q)) / inertia
        dq += STEP * ddq
        q += STEP * dq
    current = rows[:, 1] / (LINK.ratio * LINK.constant)
    every = slice(None, None, 4)
    noise = 0.02 * random.normal(size=len(t[every]))
    return {"t": t[every], "q1": rows[every, 0], "i1": current[every] + noise}


@pytest.mark.parametrize("seed", [0, 1])
def test_a_shaken_base_is_no_delay(seed: int) -> None:
    """Nothing comes late in slow motion, where parameters are those of the arm."""
    found = mg.diagnose(ARM, *logs(seed, 0.6), experiment=False).to_json()
    assert found["causes"] == []
    (delay,) = (c for c in found["suspects"] if c["effect"] == "time_delay")
    (form,) = (check for check in delay["checks"] if check["name"] == "form")
    assert not form["passed"]
    assert "in slow motion" in form["text"]


@pytest.mark.parametrize("late", [2, 5, 8])
def test_currents_that_are_old_are_named_with_their_age(late: int) -> None:
    """By samples, beside half a one: the log is read as if they were held after their stamps."""
    train, test = logs(0, 0.0)
    old = [{k: v[:-late] if k == "i1" else v[late:] for k, v in x.items()} for x in (*train, test)]
    (cause,) = mg.diagnose(ARM, old[:2], old[2], experiment=False).causes
    delay = cause.parameters["delay"]
    assert cause.effect == "time_delay"
    assert delay.std is not None
    assert abs(delay.value + 4e-3 * (late + 0.5)) < 3.0 * delay.std < 2e-3


def logs(seed: int, shaken: float) -> tuple[list[Table], Table]:
    """Two to train on, and one to test."""
    first, second, third = (log(3 * seed + k, shaken) for k in range(3))
    return [first, second], third
