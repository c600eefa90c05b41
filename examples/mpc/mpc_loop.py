"""The closed loop: measure, plan, apply the first input to the plant for one period."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from mpc_arm import ControlledArm
from mpc_horizon import Horizon
from mpc_plant import Plant

FloatArray = np.ndarray

# The reference swings from START to END [deg] and back with a period [s], joint by joint. Joint 1 is
# asked for more than its stroke.
START, END, PERIOD = (
    np.array([-65.0, 28.0, 125.0]),
    np.array([37.0, 74.0, 220.0]),
    np.array([36.0, 24.0, 40.0]),
)


def reference(t: FloatArray) -> FloatArray:
    """Angles and speeds at the times t, from rest: len(t) × 6 [rad, rad/s]."""
    rate = 2 * np.pi / PERIOD
    phase = np.outer(t, rate)
    half = np.deg2rad(END - START) / 2
    q = np.deg2rad(START) + half * (1 - np.cos(phase))
    states: FloatArray = np.hstack([q, half * rate * np.sin(phase)])
    return states


@dataclass(frozen=True)
class Run:
    """What happened, row by row at the times t [s]; one row of inputs fewer than of states."""

    t: FloatArray
    reference: FloatArray
    states: FloatArray
    inputs: FloatArray
    motor: FloatArray
    motor_speed: FloatArray
    cpu: FloatArray  # s per plan
    iterations: FloatArray
    failures: int

    @property
    def error(self) -> FloatArray:
        """Angles less their reference [rad]."""
        n = self.states.shape[1] // 2
        difference: FloatArray = self.states[:, :n] - self.reference[:, :n]
        return difference


def closed_loop(
    horizon: Horizon,
    plant: Plant,
    duration: float,
    progress: Callable[[int, int], None] = lambda done, total: None,
    begin: float = 0.0,
) -> Run:
    """Run from the reference at the time `begin` [s]. Raises RuntimeError where the plant leaves its strokes.

    The state is measured without noise and the plan applied without delay.
    """
    period = horizon.period
    count = round(duration / period)
    state = reference(np.array([begin]))[0]
    states, inputs, failures = [state], list[FloatArray](), 0
    cpu, iterations = list[float](), list[int]()
    guess = None
    for k in range(count):
        ahead = reference(begin + (k + np.arange(horizon.steps + 1)) * period)
        plan = horizon.solve(state, ahead, guess)
        failures += not plan.success
        # Without a plan the input stays, and the next plan starts cold.
        guess = plan.guess if plan.success else None
        held = plan.inputs if plan.success or not inputs else inputs[-1]
        state = plant.advance(state, held, period)
        states.append(state)
        inputs.append(held)
        cpu.append(plan.cpu)
        iterations.append(plan.iterations)
        progress(k + 1, count)
    t = begin + np.arange(count + 1) * period
    path = np.array(states)
    return Run(
        t,
        reference(t),
        path,
        np.array(inputs),
        *motors(horizon.arm, path),
        np.array(cpu),
        np.array(iterations),
        failures,
    )


def motors(arm: ControlledArm, states: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Places and speeds of the motors along a path, in their units."""
    n = arm.n
    rows = [arm.functions["motor_from_joint"](x[:n], x[n:], np.zeros(n)) for x in states]
    return np.array([r[0].full().ravel() for r in rows]), np.array([r[1].full().ravel() for r in rows])
