"""A link behind a belt: its own equations, and none of modelgen's; no dry friction.

One joint on a geared motor under a PD controller on the motor's encoder, from rest.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from modelgen.description import Arm, loads
from modelgen.effects import known_effects

STIFFNESS, DAMPING = 300.0, 0.6  # N m/rad, N m s/rad, of the belt between motor and link
RATIO, CONSTANT, ROTOR, VISCOUS = 8.0, 0.07, 4.0e-4, 3.0e-4  # at the motor [N m/A, kg m^2, N m s]
MASS, ARM, LINK = 1.5, 0.23, 0.1  # kg, m, kg m^2 about the joint
WHOLE = LINK + RATIO**2 * ROTOR
STEP = 2.5e-4  # s, of the simulation
Table = dict[str, np.ndarray]


def rig(stiffness: float | None = None, rotor: float = 1.0) -> Arm:
    """The rig as it is described, with a belt of this stiffness, or with none.

    rotor: the share of its inertia that it is described with.
    """
    own = LINK - MASS * ARM**2
    belt = (
        "" if stiffness is None else f"{{joint_flexibility: {{stiffness: {stiffness}, damping: {DAMPING}}}}}"
    )
    effects = ", ".join(
        ["viscous_friction, coulomb_friction", f"{{drive_inertia: {{inertia: {rotor * ROTOR:.9g}}}}}", belt]
    )
    text = f"""
schema: 1
convention: khalil_kleinfinger
arms:
  rig:
    gravity: [0, -9.81, 0]
    joints:
      - {{name: j1, drive: {{type: direct, ratio: {RATIO}, torque_constant: {CONSTANT}}},
         effects: [{effects.rstrip(", ")}]}}
    links:
      j1: {{mass: {MASS}, com: [{ARM}, 0, 0], inertia: [0.001, 0, 0, {own:.9g}, 0, {own:.9g}]}}
"""
    return loads(text, "arms.yaml", known_effects())["rig"]


@cache
def _simulated(seed: int, damping: float, fallen: bool) -> np.ndarray:
    """Time, positions of motor and link at the joint, torque there: (4, N), three periods of 8 s."""
    random = np.random.default_rng([66, seed])
    t = np.arange(0.0, 24.0, STEP)
    w = 2 * np.pi / 8.0 * np.array([1.0, 3.0, 7.0, 17.0, 37.0])
    size, phase = np.array([0.5, 0.15, 0.05, 0.012, 0.004]), random.uniform(0, 2 * np.pi, 5)
    begun = np.minimum(t / 2.0, 1.0)
    wanted = begun**2 * (3.0 - 2.0 * begun) * (np.sin(w * t[:, None] + phase) @ size)
    speed = np.gradient(wanted, STEP)
    weight = 9.81 * MASS * ARM
    motor, dm, dl = 0.0, 0.0, 0.0
    link = motor if fallen else motor - weight / STIFFNESS  # it is let go, or hangs in its belt
    rows = np.zeros((len(t), 3))
    for k in range(len(t)):
        torque = weight + 400.0 * (wanted[k] - motor) + 12.0 * (speed[k] - dm)
        rows[k] = motor, link, torque
        belt = STIFFNESS * (motor - link) + damping * (dm - dl)
        dm += STEP * (torque - belt - RATIO**2 * VISCOUS * dm) / (RATIO**2 * ROTOR)
        dl += STEP * (belt - weight * np.cos(link)) / LINK
        motor, link = motor + STEP * dm, link + STEP * dl
    return np.array([t, *rows.T])


def log(
    seed: int, side: str = "motor", rate: float = 500.0, *, damping: float = DAMPING, fallen: bool = False
) -> Table:
    """Readings of one instant, of the encoder at the motor or at the link; currents with noise. fallen: the
    link falls into its belt as the record begins.
    """
    t, motor, link, torque = _simulated(seed, damping, fallen)[:, :: round(1.0 / (rate * STEP))]
    noise = 0.01 * np.random.default_rng([67, seed]).normal(size=len(t))
    seen = {"qm1": RATIO * motor} if side == "motor" else {"q1": link}
    return {"t": t, **seen, "i1": torque / (RATIO * CONSTANT) + noise}
