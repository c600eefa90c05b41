"""Efforts that dropped out, froze or have a dead band are no readings; those that stand rightly are."""

from __future__ import annotations

import numpy as np
import pytest

import modelgen as mg
from modelgen.dataset.reading.absent import absent
from modelgen.description import loads
from modelgen.effects import known_effects

ARM = loads(
    """
schema: 1
convention: khalil_kleinfinger
arms:
  one:
    gravity: [0, -9.81, 0]
    joints:
      - {name: hip, drive: {type: direct, ratio: 40, torque_constant: 0.05},
         effects: [{viscous_friction: {coefficient: 1.0e-3}}, {coulomb_friction: {magnitude: 0.01}}]}
    links:
      hip: {mass: 3, com: [0.2, 0, 0], inertia: [0.01, 0, 0, 0.1, 0, 0.1]}
""",
    "arms.yaml",
    known_effects(),
)["one"]
INERTIA, MOMENT, VISCOUS, DRY, PERIOD = 0.22, 0.6, 1.0e-3, 0.01, 8.0
TRUTH = {"ZZ1": INERTIA, "MX1": MOMENT, "MY1": 0.0, "FV1": VISCOUS, "FC1": DRY}
T = np.arange(0.0, 24.0, 0.004)
KINDS = ("dropped out", "a number for nothing", "frozen", "dead band")


def log(seed: int, kind: str, noise: float = 0.005) -> dict[str, np.ndarray]:
    """Three periods of four harmonics about the upright, by hand, whose current is partly not read."""
    random = np.random.default_rng(seed)
    size, phase = np.array([0.5, 0.3, 0.15, 0.05]), random.uniform(0, 6.28, 4)
    w = 2 * np.pi * np.array([1, 2, 3, 5]) / PERIOD
    q, dq, ddq = (
        (size * w**k * np.sin(T[:, None] * w + phase + k * np.pi / 2)).sum(axis=1) for k in range(3)
    )
    torque = INERTIA * ddq - 9.81 * MOMENT * np.sin(q) + 40 * (VISCOUS * 40 * dq + DRY * np.sign(dq))
    current = torque / (40 * 0.05) + noise * random.standard_normal(len(T))
    places = random.integers(200, len(T) - 200, 12)
    for place in places:
        if kind == "dropped out":
            current[place : place + 10] = 0.0
        elif kind == "a number for nothing":
            current[place : place + 10] = -32.768
        elif kind == "frozen":
            current[place : place + 40] = current[place]
    if kind == "dead band":
        current[np.abs(current) < 0.3] = 0.0
    angle = q + np.pi / 2 + 2e-6 * random.standard_normal(len(T))
    return {"t": T, "q1": angle, "i1": current}


@pytest.mark.parametrize("kind", KINDS)
def test_what_was_not_read_moves_no_parameter(kind: str) -> None:
    found = mg.identify(ARM, log(1, kind), log(2, kind))
    for name, value in TRUTH.items():
        p = found.parameters[name]
        assert abs(p.value - value) < 4.0 * p.std, name
        assert p.std < 0.03 * max(value, 0.02 * MOMENT), name
    (remark,) = (x for x in mg.read_log(log(1, kind), ARM).remarks if "it was not read" in x)
    assert "i1 stands at" in remark


@pytest.mark.parametrize("kind", KINDS)
def test_what_was_not_read_is_no_cause(kind: str) -> None:
    found = mg.diagnose(ARM, train=[log(1, kind), log(2, kind)], test=log(3, kind))
    assert found.verdict == "nothing_missing", found


@pytest.mark.parametrize("noise", [0.0, 0.005])
@pytest.mark.parametrize("step", [0.0, 0.002, 0.02, 0.2])
def test_readings_are_readings(step: float, noise: float) -> None:
    """Of whatever steps, also where they are cut off; simulated ones may stand."""
    current = log(1, "", noise)["i1"]
    highest = float(np.quantile(current, 0.9))
    cut = np.minimum(current, highest)
    stands = np.concatenate([current[:2000], np.full(600, current[1999]), current[2000:]])
    for values in (current, cut) if noise else (current, cut, stands):
        read = values if not step else step * np.rint(values / step)
        assert not absent(read, np.cumsum(np.ones(len(read)))).any()


def test_an_effort_that_is_commanded_in_steps_is_read() -> None:
    levels = np.random.default_rng(1).uniform(-1.0, 1.0, 60)
    assert not absent(np.repeat(levels, 100), T).any()
    trapezoid = np.interp(T % 8.0, [0.0, 2.0, 4.0, 6.0, 8.0], [0.0, 1.0, 1.0, -1.0, 0.0])
    assert not absent(trapezoid, T).any()
