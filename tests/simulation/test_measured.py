"""Simulated logs: what was asked of the sensors is in the columns, and identify finds it there."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import modelgen as mg
from modelgen.description import loads
from modelgen.effects import known_effects

ARM = """
schema: 1
convention: khalil_kleinfinger
arms:
  two:
    joints:
      - {name: swing, alpha: pi/2, drive: {type: direct, ratio: 50, torque_constant: 0.1},
         effects: [viscous_friction: {coefficient: 1.0e-4}, coulomb_friction: {magnitude: 0.02},
           drive_inertia: {inertia: 3.0e-5}]}
      - {name: lift, type: prismatic, r: 0, drive: {type: direct, ratio: 600, torque_constant: 0.1},
         effects: [viscous_friction: {coefficient: 1.0e-4}, coulomb_friction: {magnitude: 0.02},
           drive_inertia: {inertia: 3.0e-5}]}
    links:
      swing: {mass: 3, com: [0.2, 0.01, 0], inertia: [0.01, 0, 0, 0.05, 0, 0.05]}
      lift: {mass: 1.5, com: [0.15, 0, 0], inertia: [0.003, 0, 0, 0.02, 0, 0.02]}
"""


@pytest.fixture(scope="module")
def arm() -> mg.Arm:
    return loads(ARM, "arm.yaml", known_effects())["two"]


def run(arm: mg.Arm, seed: int = 0, **asked: Any) -> mg.Simulation:
    t = np.arange(1601) / 200
    random = np.random.default_rng(seed + 5)
    w, phase = 2 * np.pi * np.array([[0.25, 0.25], [0.75, 0.625], [1.5, 1.25]]), random.uniform(0, 6, (3, 2))
    q = (np.array([0.4, 0.05]) * np.sin(t[:, None, None] * w + phase) / [[1], [2], [4]]).sum(axis=1)
    reference = {"t": t, "q1": q[:, 0], "q2": q[:, 1]}
    return mg.simulate(arm, control="computed_torque", reference=reference, rate=200.0, seed=seed, **asked)


def test_encoders_count_and_efforts_have_noise(arm: mg.Arm) -> None:
    plain, found = run(arm), run(arm, encoder=[4096.0, 1e5], noise=[0.03, 0.0])
    assert found.log is not None
    assert plain.log is None
    assert list(found.log) == ["t", "q1", "q2", "i1", "i2"]
    for k, count in enumerate((2 * np.pi / 4096, 1e-5)):
        read = found.log[f"q{k + 1}"]
        assert read / count == pytest.approx(np.rint(read / count), abs=1e-6)
        assert np.abs(read - plain.q[:, k]).max() == pytest.approx(count / 2, rel=0.05)
    assert np.std(found.log["i1"] - plain.inputs[:, 0]) == pytest.approx(0.03, rel=0.1)
    assert found.log["i2"] == pytest.approx(plain.inputs[:, 1])
    at_motors = run(arm, encoder=2048.0, encoder_at="motor").log
    assert at_motors is not None
    assert at_motors["qm1"] == pytest.approx(50 * plain.q[:, 0], abs=0.51 * 2 * np.pi / 2048)
    assert found.table().splitlines()[0] == "t,q1,q2,i1,i2"


def test_jitter_moves_samples_and_stamps_together(arm: mg.Arm) -> None:
    plain, log = run(arm), run(arm, jitter=5e-4).log
    assert log is not None
    assert np.std(log["t"] - plain.t) == pytest.approx(5e-4, rel=0.1)
    later = plain.q[:, 0] + (log["t"] - plain.t) * plain.dq[:, 0]
    assert log["q1"] == pytest.approx(later, abs=2e-5)


@pytest.mark.parametrize("hold", ["following", "instant", "previous"])
def test_the_instant_of_the_efforts_is_found_again(hold: str, arm: mg.Arm) -> None:
    train, test = (run(arm, seed, hold=hold, encoder=1e6, noise=1e-4).log for seed in (1, 2))
    found = mg.identify(arm, train, test).to_json()["log"]
    assert found["effort_instant"]["fits"] == found["hold"] == hold


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"encoder": -1.0}, "--encoder: found -1, expected 0 or more"),
        ({"hold": "later"}, "--hold: found 'later', expected following, instant, previous"),
        ({"encoder_at": "link"}, "--encoder-at: found 'link'"),
        ({"jitter": 0.01}, "--jitter: found 0.01 s, expected at most a quarter of the period"),
    ],
)
def test_what_no_sensor_does_is_refused(asked: dict[str, Any], said: str, arm: mg.Arm) -> None:
    with pytest.raises(mg.InputError) as caught:
        run(arm, **asked)
    assert said in str(caught.value)
