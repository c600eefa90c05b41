"""Currents that a robot publishes more seldom than its angles, each with a stamp of its own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import modelgen as mg

G, RATIO, CONSTANT = 9.81, 50.0, 0.08
MASS, COM, INERTIA = 6.0, 0.25, 0.2
ROTOR, VISCOUS, DRY = 2e-4, 8e-4, 0.02
PERIOD, PERIODS = 8.0, 3
WAVES = ((1, 0.5), (2, 0.3), (3, 0.15), (5, 0.05))
ARMS = f"""
schema: 1
convention: khalil_kleinfinger
arms:
  pendulum:
    gravity: [0, -{G}, 0]
    joints:
      - name: shoulder
        d: 0
        drive: {{type: direct, ratio: {RATIO}, torque_constant: {CONSTANT}}}
        effects: [viscous_friction, coulomb_friction, drive_inertia]
    links:
      shoulder: {{mass: {MASS}, com: [{COM}, 0, 0], inertia: [0.01, 0, 0, {INERTIA}, 0, {INERTIA}]}}
"""


def log(path: Path, seed: int, angles: float, currents: float) -> Path:
    """A record whose angles and currents have rates [Hz] and instants of their own; noise 4 mA, 0.2 mrad."""
    random = np.random.default_rng(seed)
    phases = random.uniform(0.0, 2.0 * np.pi, len(WAVES))

    def motion(t: np.ndarray) -> list[np.ndarray]:
        found = [np.full_like(t, 0.3), np.zeros_like(t), np.zeros_like(t)]
        for (harmonic, size), phase in zip(WAVES, phases, strict=True):
            w = 2.0 * np.pi * harmonic / PERIOD
            for k in range(3):
                found[k] += size * w**k * np.sin(w * t + phase + 0.5 * np.pi * k)
        return found

    places = np.arange(0.0, PERIOD * PERIODS, 1.0 / angles)
    instants = np.arange(0.0013, PERIOD * PERIODS, 1.0 / currents)
    q, dq, ddq = motion(instants)
    torque = (INERTIA + MASS * COM**2) * ddq + MASS * G * COM * np.cos(q)
    motor = RATIO * (ROTOR * ddq + VISCOUS * dq) + DRY * np.sign(dq)
    current = (torque / RATIO + motor) / CONSTANT + 4e-3 * random.standard_normal(len(instants))
    angle = RATIO * motion(places)[0] + 2e-4 * random.standard_normal(len(places))
    rows = [(t, f"{t:.6f},{x:.7f},") for t, x in zip(places, angle, strict=True)]
    rows += [(t, f"{t:.6f},,{x:.6f}") for t, x in zip(instants, current, strict=True)]
    path.write_text("t,qm1,i1\n" + "\n".join(row for _, row in sorted(rows)) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize("currents", [50.0, 100.0])
def test_what_lies_between_two_readings_of_a_current_is_no_cause(currents: float, tmp_path: Path) -> None:
    arms = tmp_path / "arms.yaml"
    arms.write_text(ARMS, encoding="utf-8")
    arm = mg.load_arms(arms)["pendulum"]
    a, b, test = (log(tmp_path / f"{k}.csv", k, 500.0, currents) for k in range(3))
    found = mg.diagnose(arm, train=[a, b], test=test)
    assert found.verdict == "nothing_missing", found
    fitted = mg.identify(arm, train=[a, b], test=test)
    true = {"ZZ1R": INERTIA + MASS * COM**2 + RATIO**2 * ROTOR, "MX1": MASS * COM, "FV1": VISCOUS, "FC1": DRY}
    for name, value in true.items():
        p = fitted.parameters[name]
        assert abs(p.value - value) < 4.0 * p.std, name
        assert p.std < 0.02 * value, name
