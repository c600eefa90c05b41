"""A rod on a geared motor whose friction grows with its weight, alone or beside a spring: its own equation.

It swings over a range in which the spring and the weight look much alike.
"""

import numpy as np

from modelgen.numeric import Array

ARM = """
schema: 1
convention: khalil_kleinfinger
arms:
  rod:
    gravity: [0, -9.81, 0]
    joints:
      - name: shoulder
        drive: {type: direct, ratio: 100, torque_constant: 0.05}
        effects: [viscous_friction, coulomb_friction, drive_inertia MORE]
"""
MOMENT, INERTIA, STIFFNESS, PRELOAD, LOADED = 0.6, 0.12, 9.0, -2.5, 0.09  # kg m, kg m^2, N m/rad, N m, 1
VISCOUS, DRY = 0.5, 0.8  # at the joint, N m s/rad and N m


def described(*effects: str) -> str:
    """The description with further effects at the joint."""
    return ARM.replace(" MORE", "".join(f", {name}" for name in effects))


def log(
    seed: int, *, spring: bool, reach: float = 0.2, inertia: bool = False, loaded: float = LOADED
) -> dict[str, Array]:
    """Three periods of 8 s at 250 Hz: positions with 1e-5 rad, currents with 2 mA of noise.

    inertia: whether the gear's load is all that moves the rod, not its weight alone.
    """
    random = np.random.default_rng(seed)
    t = np.arange(6000) / 250.0
    w = 2 * np.pi / 8.0 * np.arange(1, 6)
    a, b = random.normal(size=(2, 5)) * reach / np.arange(1, 6)
    phase = np.outer(t, w)
    c, s = np.cos(phase), np.sin(phase)
    q, dq, ddq = 0.6 + c @ a + s @ b, -s @ (a * w) + c @ (b * w), -c @ (a * w**2) - s @ (b * w**2)
    weight = 9.81 * MOMENT * np.cos(q)
    load = np.abs(weight + INERTIA * ddq * inertia)
    torque = INERTIA * ddq + weight + VISCOUS * dq + (DRY + loaded * load) * np.sign(dq)
    if spring:
        torque += STIFFNESS * q + PRELOAD
    current = torque / 5.0 + 0.002 * random.normal(size=len(t))
    return {"t": t, "q1": q + 1e-5 * random.normal(size=len(t)), "i1": current}
