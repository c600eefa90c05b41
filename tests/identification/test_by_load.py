"""Friction in proportion to the load of a swinging rod that a spring holds, by the rod's own equation."""

from pathlib import Path

import numpy as np
import pytest

import modelgen as mg

ARM = """
schema: 1
convention: khalil_kleinfinger
arms:
  rod:
    gravity: [0, -9.81, 0]
    joints:
      - name: shoulder
        drive: {type: direct, ratio: 100, torque_constant: 0.05}
        effects: [viscous_friction, coulomb_friction, drive_inertia, load_dependent_friction SPRING]
"""
MOMENT, INERTIA, STIFFNESS, PRELOAD, LOADED = 0.6, 0.12, 9.0, -2.5, 0.09  # kg m, kg m^2, N m/rad, N m, 1
VISCOUS, DRY = 0.5, 0.8  # at the joint, N m s/rad and N m


def _arm(tmp_path: Path, *, spring: bool) -> mg.Arm:
    path = tmp_path / "arm.yaml"
    path.write_text(ARM.replace(" SPRING", ", spring" if spring else ""), encoding="utf-8")
    return mg.load_arms(path)["rod"]


def _log(seed: int, *, spring: bool) -> dict[str, np.ndarray]:
    """Three periods of 8 s at 250 Hz: positions with 1e-5 rad, currents with 2 mA of noise."""
    random = np.random.default_rng(seed)
    t = np.arange(6000) / 250.0
    w = 2 * np.pi / 8.0 * np.arange(1, 6)
    a, b = random.normal(size=(2, 5)) * 0.2 / np.arange(1, 6)
    phase = np.outer(t, w)
    c, s = np.cos(phase), np.sin(phase)
    q, dq, ddq = 0.6 + c @ a + s @ b, -s @ (a * w) + c @ (b * w), -c @ (a * w**2) - s @ (b * w**2)
    weight = 9.81 * MOMENT * np.cos(q)
    torque = INERTIA * ddq + weight + VISCOUS * dq + (DRY + LOADED * np.abs(weight)) * np.sign(dq)
    if spring:
        torque += STIFFNESS * q + PRELOAD
    current = torque / 5.0 + 0.002 * random.normal(size=len(t))
    return {"t": t, "q1": q + 1e-5 * random.normal(size=len(t)), "i1": current}


@pytest.mark.parametrize("spring", [False, True], ids=["alone", "beside a spring"])
def test_the_friction_is_that_of_the_load_that_is_found(tmp_path: Path, spring: bool) -> None:
    """With columns of the load of the fit before it was off by dozens of its deviations."""
    arm = _arm(tmp_path, spring=spring)
    found = mg.identify(arm, _log(0, spring=spring), _log(1, spring=spring)).parameters
    wanted = {"FL1": LOADED, "FC1": DRY / 100.0, "FV1": VISCOUS / 1e4, "MX1": MOMENT}
    wanted |= {"KS1": STIFFNESS, "KO1": PRELOAD} if spring else {}
    for name, value in wanted.items():
        e = found[name]
        assert e.std is not None
        assert abs(e.value - value) < max(4.0 * e.std, 0.002 * abs(value)), (name, e)
    friction = found["FL1"].std
    assert friction is not None
    assert friction < (0.01 if spring else 0.002)
