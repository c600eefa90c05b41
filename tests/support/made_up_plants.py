"""Arms with an effect that the catalogue lacks, by equations of motion that share no code with modelgen.

A pendulum and a planar arm of two links in the vertical plane, by Lagrange (Spong, Hutchinson and Vidyasagar
2006, 7.3.2), with forces by the Jacobians of their points. Their joints have no dry friction, as on air
bearings: a current that is held for a sample would be that of no instant where friction turns round.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from modelgen.numeric import Array

G = 9.81
LENGTH = 0.43  # m, between the axes of the planar arm
MASS, COM, INERTIA = (6.0, 4.0), (0.2, 0.18), (0.12, 0.08)  # kg, m, kg m^2 about the centre of mass
RATIO, CONSTANT = (100.0, 80.0), (0.06, 0.05)  # turns of the motor, N m/A
ROTOR, VISCOUS = (2e-4, 1.5e-4), (1.5e-3, 1e-3)  # kg m^2, N m s/rad at the motor
CRITICAL, DRAG = 40.0, 3e-3  # rad/s, N m s/rad
TOOL, DAMPING = 0.3, 25.0  # m, N s/m
WHEEL_MASS, WHEEL_RADIUS, WHEEL_RATIO = 1.5, 0.2, 2.0  # kg, m, turns per turn of the joint
LONGER = 0.05  # m
ASYMMETRY = 0.06

Motion = tuple[Array, Array, Array]  # q, dq, ddq, (N, n) each
Law = Callable[[Array, Array, Array], Array]  # of one joint or all, (N, n) each


def pendulum(q: Array, dq: Array, ddq: Array) -> Array:
    """Torque (N, 1) at the joint."""
    return (INERTIA[0] + MASS[0] * COM[0] ** 2) * ddq + MASS[0] * G * COM[0] * np.cos(q)


def planar(q: Array, dq: Array, ddq: Array, length: float = LENGTH) -> Array:
    """Torques (N, 2) at the joints."""
    (q1, q2), (d1, d2), (a1, a2) = q.T, dq.T, ddq.T
    (m1, m2), (c1, c2), (i1, i2) = MASS, COM, INERTIA
    h = m2 * length * c2
    m11 = m1 * c1**2 + i1 + m2 * (length**2 + c2**2) + i2 + 2 * h * np.cos(q2)
    m12 = m2 * c2**2 + i2 + h * np.cos(q2)
    m22 = m2 * c2**2 + i2
    upper, fore = G * (m1 * c1 + m2 * length) * np.cos(q1), G * m2 * c2 * np.cos(q1 + q2)
    first = m11 * a1 + m12 * a2 - h * np.sin(q2) * (2 * d1 * d2 + d2**2) + upper + fore
    second = m12 * a1 + m22 * a2 + h * np.sin(q2) * d1**2 + fore
    return np.column_stack([first, second])


def eddy_current_drag(_: Array, dq: Array, ddq: Array) -> Array:
    """Torque (N, 1) at the joint: its drag times the motor's speed, over its growth."""
    v = RATIO[0] * dq
    return RATIO[0] * DRAG * v / (1 + (v / CRITICAL) ** 2)


def geared_counterweight(q: Array, dq: Array, ddq: Array) -> Array:
    """Torque (N, 1) at the joint of a mass on a wheel about a fixed axis, geared to it."""
    angle, moment = WHEEL_RATIO * q, WHEEL_MASS * WHEEL_RADIUS
    return WHEEL_RATIO * (moment * WHEEL_RADIUS * WHEEL_RATIO * ddq + moment * G * np.cos(angle))


def tool_damping(q: Array, dq: Array, ddq: Array) -> Array:
    """Torques (N, 2): the force on the tool, by the Jacobian of its place."""
    (q1, q2), (d1, d2) = q.T, dq.T
    jx = np.array([-LENGTH * np.sin(q1) - TOOL * np.sin(q1 + q2), -TOOL * np.sin(q1 + q2)])
    jy = np.array([LENGTH * np.cos(q1) + TOOL * np.cos(q1 + q2), TOOL * np.cos(q1 + q2)])
    vx, vy = jx[0] * d1 + jx[1] * d2, jy[0] * d1 + jy[1] * d2
    return DAMPING * np.column_stack([jx[k] * vx + jy[k] * vy for k in range(2)])


@dataclass(frozen=True)
class Plant:
    """An arm of n joints. links: torques of its links. besides: torques of the effect, by the motion.

    asymmetric: whether the last drive's amplifier is.
    """

    n: int
    links: Law
    besides: Law | None = None
    asymmetric: bool = False

    def currents(self, q: Array, dq: Array, ddq: Array) -> Array:
        """Currents (N, n) [A] of the motion (N, n) each."""
        ratio, constant, rotor, viscous = (np.array(x[: self.n]) for x in (RATIO, CONSTANT, ROTOR, VISCOUS))
        torque = self.links(q, dq, ddq) + (0.0 if self.besides is None else self.besides(q, dq, ddq))
        current = (torque / ratio + ratio * (rotor * ddq + viscous * dq)) / constant
        if self.asymmetric:
            last = current[:, -1]
            current[:, -1] = np.where(last > 0, last / (1 + ASYMMETRY), last / (1 - ASYMMETRY))
        return np.asarray(current)


def longer(q: Array, dq: Array, ddq: Array) -> Array:
    """Torques (N, 2) of the planar arm with a longer first link."""
    return planar(q, dq, ddq, LENGTH + LONGER)


PLAIN = {1: Plant(1, pendulum), 2: Plant(2, planar)}
PLANTS: Mapping[str, Plant] = {
    "eddy_current_drag": Plant(1, pendulum, eddy_current_drag),
    "tool_damping": Plant(2, planar, tool_damping),
    "geared_counterweight": Plant(1, pendulum, geared_counterweight),
    "link_length_error": Plant(2, longer),
    "amplifier_asymmetry": Plant(1, pendulum, asymmetric=True),
}


def description(n: int, effects: str | None = None) -> str:
    """arms.yaml of the pendulum or the planar arm, with the usual effects.

    effects: of the last joint in YAML, after the plant's own friction and inertia at every joint; None for
    the usual ones.
    """
    joints, links = [], []
    for k in range(n):
        drive = f"{{type: direct, ratio: {RATIO[k]}, torque_constant: {CONSTANT[k]}}}"
        own = (
            f"{{viscous_friction: {{coefficient: {VISCOUS[k]}}}}}, {{drive_inertia: {{inertia: {ROTOR[k]}}}}}"
        )
        own += f", {effects}" if effects and k == n - 1 else ""
        own = "" if effects is None else f", effects: [{own}]"
        inertia = f"[0.01, 0, 0, {INERTIA[k]}, 0, {INERTIA[k]}]"
        joints.append(f"{{name: j{k + 1}, d: {LENGTH if k else 0}, drive: {drive}{own}}}")
        links.append(f"j{k + 1}: {{mass: {MASS[k]}, com: [{COM[k]}, 0, 0], inertia: {inertia}}}")
    lines = [
        "schema: 1",
        "convention: khalil_kleinfinger",
        "arms:",
        "  made_up:",
        "    gravity: [0, -9.81, 0]",
    ]
    lines += ["    joints:", *(f"      - {j}" for j in joints), "    links:", *(f"      {x}" for x in links)]
    return "\n".join(lines) + "\n"


RATE, PERIOD, PERIODS = 100.0, 4.0, 3  # Hz, s
WAVES = ((1, 0.6), (2, 0.4), (3, 0.15))  # harmonic, amplitude [rad]
CENTRE = (0.5, -0.4)  # rad
NOISE, COUNT = 0.02, 2e-4  # A, rad at the motor


def motion(t: Array, phase: Array) -> Motion:
    """Position, speed and acceleration (N, n) at times t (N,) [s]. phase: (n, waves) [rad]."""
    n = len(phase)
    q, dq, ddq = np.tile(CENTRE[:n], (len(t), 1)), np.zeros((len(t), n)), np.zeros((len(t), n))
    for k, (harmonic, size) in enumerate(WAVES):
        w = 2 * np.pi * harmonic / PERIOD
        angle = w * t[:, None] + phase[:, k]
        q += size * np.sin(angle)
        dq += size * w * np.cos(angle)
        ddq -= size * w**2 * np.sin(angle)
    return q, dq, ddq


def log(path: Path, plant: Plant, seed: int, periods: int = PERIODS) -> Path:
    """A log with noise, each current held from its stamp on for a sample."""
    random = np.random.default_rng(seed)
    t = np.arange(0.0, PERIOD * periods, 1 / RATE)
    phase = random.uniform(0.0, 2 * np.pi, (plant.n, len(WAVES)))
    current = plant.currents(*motion(t + 0.5 / RATE, phase))
    current = current + NOISE * random.standard_normal(current.shape)
    motor = motion(t, phase)[0] * np.array(RATIO[: plant.n]) + COUNT * random.standard_normal(current.shape)
    names = ["t", *(f"qm{k + 1}" for k in range(plant.n)), *(f"i{k + 1}" for k in range(plant.n))]
    table = np.column_stack([t, motor, current])
    np.savetxt(path, table, "%.9g", ",", header=",".join(names), comments="")
    return path


def held(path: Path, plant: Plant) -> Path:
    """A mapping of `log` that says when its currents act. Where nobody says it, the parameters' deviations
    hold what the data leave open, which is a tenth of a sample here.
    """
    lines = ["schema: 1", "time: {column: t, unit: s}", "hold: following", "joints:"]
    for k in range(1, plant.n + 1):
        position, effort = f"{{column: qm{k}, unit: rad, side: motor}}", f"{{column: i{k}, unit: A}}"
        lines.append(f"  - {{position: {position}, effort: {effort}}}")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path
