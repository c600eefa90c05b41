"""An arm that is described with an elastic joint is identified as it is, from either side of the joint."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import modelgen as mg
from modelgen.description import loads
from modelgen.effects import known_effects

STIFFNESS, DAMPING = 300.0, 0.6  # N m/rad, N m s/rad, of a belt between motor and link
RATIO, CONSTANT, ROTOR, VISCOUS = 8.0, 0.07, 4.0e-4, 3.0e-4  # at the motor [N m/A, kg m^2, N m s]
MASS, ARM, LINK = 1.5, 0.23, 0.1  # kg, m, kg m^2 about the joint
WHOLE = LINK + RATIO**2 * ROTOR
STEP = 2.5e-4  # s, of the simulation; every eighth is logged
Table = dict[str, np.ndarray]


def description(stiffness: float) -> str:
    """The rig."""
    own = LINK - MASS * ARM**2
    rotor, belt = f"{{inertia: {ROTOR}}}", f"{{stiffness: {stiffness}, damping: {DAMPING}}}"
    effects = f"{{drive_inertia: {rotor}}}, {{joint_flexibility: {belt}}}"
    return f"""
schema: 1
convention: khalil_kleinfinger
arms:
  rig:
    gravity: [0, -9.81, 0]
    joints:
      - {{name: j1, drive: {{type: direct, ratio: {RATIO}, torque_constant: {CONSTANT}}},
         effects: [viscous_friction, coulomb_friction, {effects}]}}
    links:
      j1: {{mass: {MASS}, com: [{ARM}, 0, 0], inertia: [0.001, 0, 0, {own:.9g}, 0, {own:.9g}]}}
"""


def rig(stiffness: float) -> mg.Arm:
    return loads(description(stiffness), "arms.yaml", known_effects())["rig"]


@cache
def log(seed: int, side: str) -> Table:
    """Three periods of 8 s under a PD controller on the motor's encoder, from rest; no dry friction."""
    random = np.random.default_rng([66, seed])
    t = np.arange(0.0, 24.0, STEP)
    w = 2 * np.pi / 8.0 * np.array([1.0, 3.0, 7.0, 17.0, 37.0])
    size, phase = np.array([0.5, 0.15, 0.05, 0.012, 0.004]), random.uniform(0, 2 * np.pi, 5)
    angle, begun = w * t[:, None] + phase, np.minimum(t / 2.0, 1.0)
    begun = begun**2 * (3.0 - 2.0 * begun)
    wanted = begun * (np.sin(angle) @ size)
    speed = np.gradient(wanted, STEP)
    # it hangs in its belt
    motor, dm, dl = 0.0, 0.0, 0.0
    link = motor - 9.81 * MASS * ARM / STIFFNESS
    rows = np.zeros((len(t), 3))
    for k in range(len(t)):
        torque = 9.81 * MASS * ARM + 400.0 * (wanted[k] - motor) + 12.0 * (speed[k] - dm)
        rows[k] = motor, link, torque
        belt = STIFFNESS * (motor - link) + DAMPING * (dm - dl)
        dm += STEP * (torque - belt - RATIO**2 * VISCOUS * dm) / (RATIO**2 * ROTOR)
        dl += STEP * (belt - 9.81 * MASS * ARM * np.cos(link)) / LINK
        motor, link = motor + STEP * dm, link + STEP * dl
    motor, link, torque = rows[::8].T
    current = torque / (RATIO * CONSTANT) + 0.01 * random.normal(size=len(torque))
    seen = {"qm1": RATIO * motor} if side == "motor" else {"q1": link}
    return {"t": t[::8], **seen, "i1": current}


def found(stiffness: float, side: str) -> mg.IdentificationResult:
    return mg.identify(rig(stiffness), log(0, side), log(1, side))


@pytest.mark.parametrize("side", ["motor", "link"])
def test_parameters_beside_an_elastic_joint(side: str) -> None:
    """Those of the arm; without the belt's give its inertia is another."""
    soft, stiff = found(STIFFNESS, side).parameters, found(1e6, side).parameters
    assert soft["ZZ1R"].value == pytest.approx(WHOLE, rel=0.01)
    assert soft["MX1"].value == pytest.approx(MASS * ARM, rel=0.003)
    assert abs(stiff["ZZ1R"].value / WHOLE - 1.0) > 0.04


def test_what_is_left_beside_an_elastic_joint_is_noise() -> None:
    result = found(STIFFNESS, "motor")
    assert result.parameters["FV1"].value == pytest.approx(VISCOUS, rel=0.1)
    assert max(result.to_json()["test"]["rmse"]) < 0.01


def test_a_joint_that_is_far_too_soft_is_asked_about() -> None:
    assert any("unexplained" in doubt for doubt in found(30.0, "motor").to_json()["doubts"])
