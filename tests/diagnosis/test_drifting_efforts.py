"""What runs away over a record repeats with no period and is no noise: not nothing is missing."""

from __future__ import annotations

import numpy as np
import pytest
from geared_link import LINK, sines

import modelgen as mg
from modelgen.description import loads

ARM = loads(LINK.description(values=False))["one"]


def log(seed: int, weaker: float, wander: float = 0.0) -> dict[str, np.ndarray]:
    """Five periods of the link at 200 Hz. weaker: part of its torque that the motor loses with 15 s; wander:
    that its supply takes and gives, in waves of 23 s.
    """
    random = np.random.default_rng([33, seed])
    t = np.arange(0.0, 40.0, 0.005)
    q, dq, ddq = sines(t, random.uniform(0.0, 2 * np.pi, 4))
    current = LINK.currents(q, dq, ddq) / (1.0 - weaker * (1.0 - np.exp(-t / 15.0)))
    current *= 1.0 + wander * np.sin(2.0 * np.pi * t / 23.0)
    return {"t": t, "q1": q, "i1": current + 0.06 * random.normal(size=len(t))}


@pytest.mark.parametrize("weaker", [0.08, 0.0])
def test_a_motor_that_loses_torque_is_no_noise(weaker: float) -> None:
    logs = [log(k, weaker) for k in range(3)]
    found = mg.diagnose(ARM, logs[:2], logs[2], experiment=False)
    assert not found.causes
    asked = any("does the motor lose torque as it warms" in doubt for doubt in found.to_json()["doubts"])
    assert asked == bool(weaker)
    assert found.verdict == ("outside_catalogue" if weaker else "nothing_missing")
    if weaker:
        assert found.reason.startswith("the efforts of hip change against the model's")


def test_nor_is_one_that_gains_and_loses_torque() -> None:
    """What grows and falls over a record leaves no line: it takes a polynomial to see it."""
    logs = [log(k, 0.0, 0.06) for k in range(3)]
    found = mg.diagnose(ARM, logs[:2], logs[2], experiment=False).to_json()
    assert found["verdict"] == "outside_catalogue"
    (doubt,) = found["doubts"]
    assert "grow or shrink against the model's, by 1" in doubt
