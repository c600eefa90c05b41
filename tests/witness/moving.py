"""Motions from other people's mechanics: links by Pinocchio or MuJoCo, drives from their points, scipy."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from modelgen.description import Arm
from witness.bodies import Body
from witness.geometry import moving
from witness.levers import Drive
from witness.multi_body import MultiBody
from witness.rigid_bodies import RigidBodies

Array = NDArray[np.float64]


def trajectory(
    arm: Arm,
    bodies: Sequence[Body],
    drives: Mapping[str, Array],
    q0: Array,
    currents: Array,
    times: Array,
    engine: str,
) -> Array:
    """q (S, n) at `times` of the arm from rest with rotor inertia and viscous friction at each motor.

    currents: (S, n), each held from its time on. drives: "inertia" and "viscous" (n,) at the motor
    coordinates. engine: "pinocchio" or "mujoco".
    """
    made = [Drive(arm, i) for i in moving(arm)]
    links = RigidBodies(arm, bodies) if engine == "pinocchio" else MultiBody(arm, bodies)
    n = len(q0)

    def rate(y: Array, current: Array) -> Array:
        q, dq = y[:n], y[n:]
        k1 = np.array([d.k1(x) for d, x in zip(made, q, strict=True)])
        slope = np.array([d.slope(x) for d, x in zip(made, q, strict=True)])
        constant = np.array([d.constant for d in made])
        own = drives["viscous"] * k1 * dq + drives["inertia"] * slope * dq**2
        effort = k1 * (constant * current - own)
        # The rotors' inertia on the left: M ddq = links' effort, so add k1^2 Ia to M.
        mass = links.mass_matrix(q)
        free = links.acceleration(q, dq, effort)
        return np.concatenate([dq, np.linalg.solve(mass + np.diag(drives["inertia"] * k1**2), mass @ free)])

    path = [np.concatenate([q0, 0 * q0])]
    for begin, end, current in zip(times[:-1], times[1:], currents, strict=False):
        found = solve_ivp(
            lambda t, y, now=current: rate(y, now), (begin, end), path[-1], "DOP853", rtol=1e-11, atol=1e-12
        )
        assert found.status == 0
        path.append(found.y[:, -1])
    return np.array(path)[:, :n]
