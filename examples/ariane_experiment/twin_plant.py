"""The experiment: the arm under cascaded PI control, and what a 10 Hz logger keeps of it.

Position, velocity and current are controlled by a PI regulator each, in motor coordinates, as on the arm of
Leborne, Creuze, Chemori and Brignone (2018), IV-B. Positions are known in whole increments only. The current
regulators oscillate, as the paper reports (IV-E): a sine whose phase wanders, fed in at the reference, so
that the arm feels it too. Its amplitude is chosen so that samples scatter as the paper's do, by about 0.12 A.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.linalg import expm
from twin_body import LEVERS, MOTORS, model

Array = NDArray[np.float64]

STEP = 1e-3  # s, of the mechanics and of the velocity loop
POSITION_EVERY = 10  # steps: the position loop runs at 100 Hz
LOG_EVERY = 100  # steps: 10 Hz
RESISTANCE, INDUCTANCE = 2.0, 1e-3  # ohm, H
CURRENT_LOOP = 2 * math.pi * 800.0  # rad/s
SPEED_LOOP = 100.0  # rad/s
SPEED_INTEGRAL = 30.0  # 1/s
POSITION_LOOP, POSITION_INTEGRAL = 15.0, 1.0  # 1/s
SPEED_FILTER = 2 * math.pi * 60.0  # rad/s, of the speed, which drives measure by the time between increments
RIPPLE = (0.15, 0.16, 0.15)  # A, amplitude of the regulators' oscillation
RIPPLE_FREQUENCY = (313.0, 347.0, 389.0)  # Hz
WANDER = 12.0  # rad/sqrt(s), of its phase: forgotten within hundredths of a second
SENSOR = 0.02  # A, standard deviation of a current sample
APPROACH = 6.0  # s, to the trajectory's first point and onto its speed, not recorded


@dataclass(frozen=True)
class Recording:
    """t: (N,) [s]. counts: (N, 3) whole motor increments. sample: (N, 3) current at t [A]; mean: (N, 3) over
    the tenth of a second before t [A]. q: (N, 3) true joint angles [rad].
    """

    t: Array
    counts: Array
    sample: Array
    mean: Array
    q: Array


def reference(t: Array, points: Array, periods: int) -> tuple[Array, float]:
    """Set-points (K, 3) [increments] at every step, and the time [s] at which recording begins.

    t, points: one period, its first row repeated as the last. The arm starts at rest and is drawn into the
    periodic motion, whose amplitude about its first point grows smoothly over the approach.
    """
    period = t[-1] - t[0]
    closed = np.vstack([points[:-1], points[:1]])
    series = CubicSpline(t - t[0], closed, bc_type="periodic")
    time = np.arange(round((APPROACH + periods * period) / STEP) + 1) * STEP - APPROACH
    grown = np.clip(1 + time / APPROACH, 0, 1)[:, None]
    weight = grown**3 * (10 - 15 * grown + 6 * grown**2)
    return points[0] + weight * (series(time % period) - points[0]), APPROACH


def record(t: Array, points: Array, periods: int, seed: int) -> Recording:
    """The arm tracks `periods` of the set-points (N, 3) [increments] at t (N,) [s]; seed: of the noise."""
    wanted, begin = reference(t, points, periods)
    rng = np.random.default_rng(seed)
    phase = rng.uniform(0, 2 * math.pi, 3) + np.cumsum(
        2 * math.pi * np.array(RIPPLE_FREQUENCY) * STEP
        + WANDER * math.sqrt(STEP) * rng.normal(size=(len(wanted), 3)),
        axis=0,
    )
    raw = _run(wanted, np.array(RIPPLE) * np.sin(phase))
    first = round(begin / STEP)
    kept = np.arange(first, len(wanted), LOG_EVERY)[:-1]
    means = np.cumsum(np.vstack([np.zeros(3), raw["mean"]]), axis=0)
    mean = (means[kept] - means[kept - LOG_EVERY]) / LOG_EVERY
    noise = SENSOR * rng.normal(size=(len(kept), 3))
    counts = np.floor(raw["motor"][kept] + 0.5)
    stamps = np.asarray((kept - first) * STEP, dtype=np.float64)
    return Recording(stamps, counts, raw["current"][kept] + noise, mean, raw["q"][kept])


def _run(wanted: Array, ripple: Array) -> dict[str, Array]:
    """Signals at every step: q [rad], motor [increments], current [A], and its mean over the step
    that follows."""
    body = model(STEP)
    data = mujoco.MjData(body)
    loops = [_Loops(k, float(wanted[0, k])) for k in range(3)]
    data.qpos[:] = [lever.joint(float(m)) for lever, m in zip(LEVERS, wanted[0], strict=True)]
    motion: list[list[float]] = []
    for k in range(len(wanted)):
        q, dq = data.qpos.tolist(), data.qvel.tolist()
        force, armature, damping, dry, row = [], [], [], [], [*q]
        for j, (lever, motor, loop) in enumerate(zip(LEVERS, MOTORS, loops, strict=True)):
            ratio, slope = lever.ratio(q[j])
            m, speed = lever.motor(q[j]), ratio * dq[j]
            current = loop.current
            mean = loop.step(wanted[k, j], m, speed, ripple[k, j], k % POSITION_EVERY == 0)
            row += [m, current, mean]
            # Virtual work: what acts on the motor acts on the joint by dm/dq; ddm = ratio ddq + slope dq^2.
            force.append(ratio * (motor.constant * mean - motor.inertia * slope * dq[j] ** 2))
            armature.append(motor.inertia * ratio**2)
            damping.append(motor.viscous * ratio**2)
            dry.append(motor.dry * abs(ratio))
        body.dof_armature[:], body.dof_damping[:], body.dof_frictionloss[:] = armature, damping, dry
        data.qfrc_applied[:] = force
        motion.append(row)
        mujoco.mj_step(body, data)
    table = np.array(motion)
    return {"q": table[:, :3], "motor": table[:, 3::3], "current": table[:, 4::3], "mean": table[:, 5::3]}


class _Loops:
    """The three regulators of a joint and its winding: L di/dt = u - R i - k dm, k the torque constant."""

    def __init__(self, joint: int, start: float) -> None:
        motor, lever = MOTORS[joint], LEVERS[joint]
        ratio = lever.ratio(lever.joint(start))[0]
        self.gain = SPEED_LOOP * (motor.inertia + 1.0 / ratio**2) / motor.constant
        self.back, self.current, self.charge = motor.constant, 0.0, 0.0
        self.position_integral = self.speed_integral = self.measured = self.asked = 0.0
        self.smoothing = 1 - math.exp(-SPEED_FILTER * STEP)
        # u = kp (reference - i) + ki (its integral); exact over a step with reference and dm held, and with
        # the integral of i as a third state.
        kp, ki = CURRENT_LOOP * INDUCTANCE, CURRENT_LOOP * RESISTANCE
        rates = np.zeros((5, 5))  # i, integral of the error, integral of i, reference, dm
        rates[0] = [
            -(RESISTANCE + kp) / INDUCTANCE,
            ki / INDUCTANCE,
            0,
            kp / INDUCTANCE,
            -self.back / INDUCTANCE,
        ]
        rates[1, [0, 3]], rates[2, 0] = [-1, 1], 1
        exact = expm(rates * STEP)[:3]
        # of the current, the charge and the mean current: what each of four has in them
        self.rows = [tuple(float(row[c]) for c in (0, 1, 3, 4)) for row in exact]

    def step(self, wanted: float, m: float, speed: float, ripple: float, position: bool) -> float:
        """Advance by a step; mean current over it [A]."""
        self.measured += self.smoothing * (speed - self.measured)
        if position:
            error = wanted - math.floor(m + 0.5)
            self.position_integral += error * POSITION_EVERY * STEP
            self.asked = POSITION_LOOP * (error + POSITION_INTEGRAL * self.position_integral)
        error = self.asked - self.measured
        self.speed_integral += error * STEP
        reference = self.gain * (error + SPEED_INTEGRAL * self.speed_integral) + ripple
        before, held = self.current, self.charge
        (a, b, c, d), (e, f, g, h), (r, s, t, u) = self.rows
        self.current = a * before + b * held + c * reference + d * speed
        self.charge = e * before + f * held + g * reference + h * speed
        return (r * before + s * held + t * reference + u * speed) / STEP
