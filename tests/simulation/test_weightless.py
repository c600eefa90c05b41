"""Arms with links that have no inertia: a motion where it exists, one clear line where it does not."""

import numpy as np
import pytest

from modelgen.description import loads
from modelgen.errors import InputError
from modelgen.simulation import Plant, plant, simulate

WRIST = """
schema: 1
convention: khalil_kleinfinger
arms:
  wrist:
    joints:
      - {{name: roll{drive}}}
      - {{name: pitch, alpha: pi/2}}
      - {{name: turn, alpha: -pi/2}}
    links:
      roll: {{mass: 0, com: [0, 0, 0], inertia: [0, 0, 0, 0, 0, 0]}}
      pitch: {{mass: 0, com: [0, 0, 0], inertia: [0, 0, 0, 0, 0, 0]}}
      turn: {{mass: {mass}, com: [0.1, 0, -0.1], inertia: [{i}, 0, 0, {i}, 0, {i}]}}
"""
DRIVEN = (
    ", drive: {type: direct, ratio: 50, torque_constant: 0.1}, effects: [{drive_inertia: {inertia: 1e-5}}]"
)


def wrist(mass: float, drive: str = "") -> Plant:
    return plant(loads(WRIST.format(mass=mass, i=mass * 0.01, drive=drive))["wrist"])


@pytest.mark.parametrize("mass", [1e-3, 1.0, 1e4])
@pytest.mark.parametrize("pitch", [0.0, 1e-7])
def test_joints_in_line_that_move_nothing_are_named_at_any_size(mass: float, pitch: float) -> None:
    with pytest.raises(InputError) as raised:
        simulate(wrist(mass), [0.1, pitch, 0.3], 0.0, 0.01, 100)
    text = str(raised.value)
    assert "at the start joints roll and turn can move together without moving any inertia" in text
    assert "links roll, pitch have no mass" in text


def test_an_arm_out_of_line_moves_and_keeps_its_energy() -> None:
    arm = wrist(1.0)
    found = simulate(arm, [0.1, 1.2, 0.0], 0.0, 0.05, 200)
    assert not found.ended
    energy = []
    for q, dq in zip(found.q, found.dq, strict=True):
        # A mass at the end of two turned axes, by differences of its place: m v^2 / 2 + m g z and the turn.
        energy.append(_energy(q, dq))
    np.testing.assert_allclose(energy, energy[0], atol=1e-6)


def _turned(q: np.ndarray) -> np.ndarray:
    """Rotation of the last link: Rz(q1) Rx(90 deg) Rz(q2) Rx(-90 deg) Rz(q3)."""

    def z(a: float) -> np.ndarray:
        return np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1.0]])

    def x(a: float) -> np.ndarray:
        return np.array([[1.0, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])

    return z(q[0]) @ x(np.pi / 2) @ z(q[1]) @ x(-np.pi / 2) @ z(q[2])


def _energy(q: np.ndarray, dq: np.ndarray) -> float:
    """Kinetic and potential energy of the last link [J], its velocities by central differences."""
    place = np.array([0.1, 0.0, -0.1])
    ahead, back = (_turned(q + s * 1e-6 * dq) for s in (1, -1))
    slope = (ahead - back) / 2e-6
    spin = _turned(q).T @ slope
    omega = np.array([spin[2, 1], spin[0, 2], spin[1, 0]])
    speed = slope @ place
    return float(0.5 * speed @ speed + 0.5 * 0.01 * omega @ omega + 9.81 * (_turned(q) @ place)[2])


def test_a_drive_s_inertia_is_enough() -> None:
    assert not simulate(wrist(1.0, DRIVEN), [0.1, 0.0, 0.3], 0.0, 0.01, 100).ended


def test_steps_that_become_too_short_end_the_motion() -> None:
    """A damper of 1e9 N m s/rad on 1 kg m^2 needs explicit steps of nanoseconds: it says so instead."""
    text = """
schema: 1
convention: khalil_kleinfinger
arms:
  stiff:
    joints: [{name: j1, effects: [{viscous_friction: {coefficient: 1e9}}]}]
    links: {j1: {mass: 1, com: [1, 0, 0], inertia: [0, 0, 0, 0, 0, 0]}}
"""
    found = simulate(plant(loads(text)["stiff"]), [0.0], [1.0], 0.1, 100, method="DOP853")
    assert "its speeds grow without bound, or the method is not one for stiff arms" in found.ended
    assert not simulate(plant(loads(text)["stiff"]), [0.0], [1.0], 0.1, 100, method="LSODA").ended
