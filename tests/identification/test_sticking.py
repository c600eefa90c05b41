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


def _log(seed: int) -> dict[str, Array]:
    """A pendulum that PD control moves along slow sines: it sticks wherever it turns round (Karnopp 1985)."""
    random, fine = np.random.default_rng(seed), 20
    size, phase = random.uniform(0.2, 0.5, 3), random.uniform(0, 6.28, 3)
    step, w = 1.0 / (RATE * fine), 2 * np.pi * np.arange(1, 4) / SECONDS
    q, dq, rows = float((size * np.sin(phase)).sum()), 0.0, []
    for k in range(round(RATE * SECONDS)):
        wanted = (size * np.sin(w * k / RATE + phase)).sum(), (size * w * np.cos(w * k / RATE + phase)).sum()
        effort = 40.0 * (wanted[0] - q) + 6.0 * (wanted[1] - dq)
        rows.append((k / RATE, q, effort + NOISE * random.normal()))
        for _ in range(fine):
            pull = effort - WEIGHT * np.cos(q)
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
