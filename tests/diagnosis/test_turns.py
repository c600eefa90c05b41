"""What a joint that sticks as it turns leaves between two readings is no cause."""

from pathlib import Path

import numpy as np
import pytest

import modelgen as mg
from modelgen.dataset.processing.rest import beside_turns
from modelgen.numeric import Array

ARM = """schema: 1
convention: khalil_kleinfinger
arms:
  bench:
    gravity: [0, 0, -9.81]
    joints:
      - {name: column, drive: {type: direct, ratio: 80, torque_constant: 0.05}}
"""
STEP, RATE, PERIOD, PERIODS = 1e-4, 100.0, 8.0, 4
INERTIA, VISCOUS, DRY, GAIN = 0.9, 0.7, 0.8, 4.0  # kg m^2, N m s, N m, N m/A


def log(seed: int, hold: str) -> Array:
    """Times, angles and currents of a joint with dry friction that sticks exactly and follows some sines.

    hold: "following", the mean current until the next reading; "instant"; a delay [s].
    """
    rng = np.random.default_rng(seed)
    orders = np.arange(1.0, 6.0)
    w, size = 2.0 * np.pi / PERIOD * orders, 0.5 * rng.uniform(-1.0, 1.0, 5) / orders
    phase = rng.uniform(0.0, 6.0, 5)
    count, period = round((PERIODS + 1) * PERIOD / STEP), round(PERIOD / STEP)
    angles = np.multiply.outer(STEP * np.arange(period), w) + phase
    wanted = (np.sin(angles) @ size, np.cos(angles) @ (size * w), -np.sin(angles) @ (size * w**2))
    ahead = INERTIA * wanted[2] + VISCOUS * wanted[1] + DRY * np.tanh(wanted[1] / 0.02)
    q, v = float(wanted[0][0]), float(wanted[1][0])
    place, effort, sticks = np.empty(count), np.empty(count), STEP * DRY / INERTIA
    for k in range(count):
        i = k % period
        place[k] = q
        effort[k] = ahead[i] + 900.0 * (wanted[0][i] - q) + 40.0 * (wanted[1][i] - v)
        free = v + STEP * (effort[k] - VISCOUS * v) / INERTIA
        v = 0.0 if abs(free) <= sticks else free - float(np.copysign(sticks, free))
        q += STEP * v
    every = round(1.0 / RATE / STEP)
    if hold == "following":
        effort = np.convolve(effort, np.ones(every) / every)[every - 1 :]
    elif hold != "instant":
        effort = np.roll(effort, -round(float(hold) / STEP))
    rows = slice(period, count - every, every)
    t = STEP * np.arange(len(place[rows])) * every
    q_read = place[rows] + 2e-6 * rng.standard_normal(len(t))
    return np.column_stack([t, q_read, (effort[rows] + 0.02 * rng.standard_normal(len(t))) / GAIN])


@pytest.mark.parametrize("hold", ["following", "instant", "0.004"])
def test_a_joint_that_sticks_as_it_turns_lacks_nothing(tmp_path: Path, hold: str) -> None:
    """Were its turns counted, something would be missing; with a delay the nearest are left out anyhow."""
    mapping = tmp_path / "mapping.yaml"
    joint = "{position: {column: q1, unit: rad}, effort: {column: i1, unit: A}}"
    mapping.write_text(f"schema: 1\nhold: {hold}\njoints:\n  - {joint}\n", encoding="utf-8")
    (tmp_path / "arm.yaml").write_text(ARM, encoding="utf-8")
    arm, logs = mg.load_arms(tmp_path / "arm.yaml")["bench"], []
    for seed in range(3):
        logs.append(str(tmp_path / f"{seed}.csv"))
        np.savetxt(logs[-1], log(seed, hold), fmt="%.9g", delimiter=",", header="t,q1,i1", comments="")
    verdicts = []
    for periods in (1.0, 0.0):
        chosen = {"dataset.turning_periods": periods}
        found = mg.diagnose(
            arm, logs[:2], logs[2], mapping=mapping, thresholds=chosen, experiment=False, processes=1
        )
        verdicts.append(found.verdict)
    assert verdicts[0] == "nothing_missing"
    assert hold == "0.004" or verdicts[1] != "nothing_missing"


def test_what_noise_turns_is_no_turn() -> None:
    """A joint that moves slowly beside the noise of its speed, and one that turns five times, with none."""
    t = np.arange(0.0, 20.0, 0.01)
    noisy = 0.05 * np.sin(1.5 * t) + 0.1 * np.random.default_rng(5).standard_normal(len(t))
    found = beside_turns(np.column_stack([noisy, np.sin(0.8 * t + 0.3)]), 1.0, 6)
    assert not found[:, 0].any()
    assert 5 <= found[:, 1].sum() <= 2 * 5
