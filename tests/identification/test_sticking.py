"""Joints that stick at their turns: what the filter carries of the rests is no friction of the motion."""

from __future__ import annotations

import numpy as np
import pytest

import modelgen as mg
from modelgen.description import loads
from modelgen.effects import known_effects
from modelgen.numeric import Array

RATE, SECONDS = 500.0, 20.0
INERTIA, WEIGHT, VISCOUS, DRY, NOISE = 0.4, 3.0, 0.5, 1.5, 2e-3  # kg m^2, N m, N m s, N m, N m
ARM = loads(
    """
schema: 1
convention: khalil_kleinfinger
arms:
  pendulum:
    gravity: [0, -9.81, 0]
    joints: [{name: hip, drive: {type: none}, effects: [viscous_friction, coulomb_friction]}]
""",
    "arms.yaml",
    known_effects(),
)["pendulum"]


def _log(
    seed: int,
    rate: float = RATE,
    period: float = SECONDS,
    count: int = 1,
    noise: float = NOISE,
    stribeck: float = 0.0,
) -> dict[str, Array]:
    """A pendulum that PD control moves along slow sines: it sticks wherever it turns round (Karnopp 1985).

    count: of periods. stribeck: friction that falls with the speed [N m].
    """
    random, fine = np.random.default_rng(seed), round(20 * RATE / rate)
    size, phase = random.uniform(0.2, 0.5, 3), random.uniform(0, 6.28, 3)
    step, w = 1.0 / (rate * fine), 2 * np.pi * np.arange(1, 4) / period
    q, dq, rows = float((size * np.sin(phase)).sum()), 0.0, []
    for k in range(round(rate * period * count)):
        wanted = (size * np.sin(w * k / rate + phase)).sum(), (size * w * np.cos(w * k / rate + phase)).sum()
        effort = 40.0 * (wanted[0] - q) + 6.0 * (wanted[1] - dq)
        rows.append((k / rate, q, effort + noise * random.normal()))
        for _ in range(fine):
            pull = effort - WEIGHT * np.cos(q) - stribeck * np.sign(dq) * np.exp(-abs(dq) / 0.1)
            if abs(dq) < 1e-7 and abs(pull) <= DRY:
                dq = 0.0
                continue
            way = np.sign(dq) if dq else np.sign(pull)
            new = dq + step * (pull - VISCOUS * dq - DRY * way) / INERTIA
            dq = 0.0 if dq and np.sign(new) != np.sign(dq) else new
            q += step * dq
    return dict(zip(("t", "q1", "tau1"), np.array(rows).T, strict=True))


@pytest.mark.parametrize("method", ["wls", "robust"])
def test_deviations_hold_where_a_joint_sticks(method: str) -> None:
    test, away, truth = _log(99), [], {"FC1": DRY, "FV1": VISCOUS, "ZZ1": INERTIA, "MX1": WEIGHT / 9.81}
    for seed in range(4):
        log = _log(seed)
        still = np.abs(np.diff(log["q1"])) < 1e-9
        assert 0.01 < still.mean() < 0.5
        found = mg.identify(ARM, log, test, method=method)
        for name, value in truth.items():
            e = found.parameters[name]
            assert e.std is not None
            away.append((e.value - value) / e.std)
    # 16 deviations of unit size: their mean square is above 2.2 in one run of a hundred.
    assert np.mean(np.square(away)) < 2.2


@pytest.mark.parametrize("seed", [0, 2])
def test_rests_of_a_sound_model_are_no_lack_of_it(seed: int) -> None:
    """What held the joint, carried on by the filter of efforts, is alike in every period."""
    logs = [_log(seed + k, 100.0, 10.0, 3, 5e-3) for k in (0, 50)]
    assert not mg.identify(ARM, *logs).to_json()["doubts"]


def test_the_filter_of_positions_makes_no_lack_of_fit() -> None:
    """It moves the instant at which a joint sets off, alike in every period."""
    logs = [_log(2 + k, 100.0, 10.0, 3, 5e-3) for k in (0, 50)]
    assert mg.identify(ARM, *logs, cutoff=1.5).to_json()["lack_of_fit"]["statistic"][0] < 2.0


def test_a_law_that_is_missing_is_seen_beside_rests() -> None:
    logs = [_log(k, 100.0, 10.0, 3, 5e-3, stribeck=0.2) for k in (0, 50)]
    (doubt,) = mg.identify(ARM, *logs).to_json()["doubts"]
    assert "the model lacks something" in doubt
