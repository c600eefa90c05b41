"""An arm of three joints that MuJoCo moves and knows all about, and logs of it as a controller writes them.

Its friction is MuJoCo's: a constraint by which joints creep before they go. Lengths in m, angles in rad.
"""

from __future__ import annotations

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ALPHA, D = (0.0, math.pi / 2, 0.0), (0.0, 0.06, 0.42)
LOW, HIGH = np.array([-1.4, -0.4, -2.2]), np.array([1.4, 1.9, 0.2])
RATIO, CONSTANT = np.array([100.0, 120.0, 100.0]), np.array([0.06, 0.04, 0.06])  # N m/A at the motor
MASS, COM = (8.7, 6.2, 3.2), (0.07, 0.23, 0.16)
TENSOR = ((0.02, 0.03, 0.03), (0.02, 0.1, 0.1), (0.01, 0.036, 0.037))
DRY, VISCOUS, ARMATURE = (4.0, 6.0, 2.5), (3.0, 4.0, 1.5), (0.8, 1.0, 0.4)  # at the joint
NOISE = np.array([0.25, 0.3, 0.12])  # N m
COUNT = 2 * math.pi / 4096  # rad of a motor
STEP, TICK, RATE, SECONDS = 5e-4, 2, 200, 30.0  # s, steps in a control period, rows a second
GAINS = np.array([[2500.0, 4000.0, 1200.0], [120.0, 200.0, 50.0], [4000.0, 6000.0, 2000.0]])  # P, D, I


def description() -> str:
    """arms.yaml of the arm, whose inertials are 5 % too heavy."""
    joints, links = [], []
    for i in range(3):
        joints.append(
            f"      - {{name: j{i + 1}, alpha: {ALPHA[i]}, d: {D[i]},\n"
            f"         limits: {{position: [{LOW[i]}, {HIGH[i]}]}},\n"
            f"         drive: {{type: direct, ratio: {RATIO[i]}, torque_constant: {CONSTANT[i]}}}}}\n"
        )
        xx, yy, zz = TENSOR[i]
        links.append(
            f"      j{i + 1}: {{mass: {1.05 * MASS[i]}, com: [{COM[i]}, 0, 0],\n"
            f"           inertia: [{xx}, 0, 0, {yy}, 0, {zz}]}}\n"
        )
    head = "schema: 1\nconvention: khalil_kleinfinger\narms:\n  arm:\n"
    head += "    gravity: [0, 0, -9.81]\n    joints:\n"
    return head + "".join(joints) + "    links:\n" + "".join(links)


def _model(tendon: str, payload: float) -> mujoco.MjModel:
    inner = ""
    for i in (2, 1, 0):
        point = f'<inertial pos="0 0 0" mass="{payload}" diaginertia="1e-5 1e-5 1e-5"/>'
        load = f'<body pos="0.3 0 0">{point}</body>'
        inner = (
            f'<body pos="{D[i]} 0 0" quat="{math.cos(ALPHA[i] / 2)} {math.sin(ALPHA[i] / 2)} 0 0">'
            f'<joint name="j{i + 1}" axis="0 0 1" armature="{ARMATURE[i]}" damping="{VISCOUS[i]}" '
            f'frictionloss="{DRY[i]}"/><inertial pos="{COM[i]} 0 0" mass="{MASS[i]}" '
            f'diaginertia="{" ".join(map(str, TENSOR[i]))}"/>{load if payload and i == 2 else inner}</body>'
        )
    motors = "".join(f'<motor joint="j{i + 1}"/>' for i in range(3))
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><compiler angle="radian"/><option timestep="{STEP}" integrator="implicitfast">'
        f'<flag contact="disable"/></option><worldbody>{inner}</worldbody>{tendon}'
        f"<actuator>{motors}</actuator></mujoco>"
    )


def log(seed: int, tendon: str = "", payload: float = 0.0) -> dict[str, Array]:
    """Times, motors' angles and currents over three periods. tendon: MJCF; payload: kg, 0.3 m along link 3.

    A row holds the positions that a control period begins with and the currents that it asks for.
    """
    random = np.random.default_rng(seed)
    t = np.arange(0.0, SECONDS, STEP)
    angle = 2 * np.pi * 0.1 * np.arange(1, 6)[:, None] * t
    sizes = random.normal(size=(2, 3, 5)) / np.arange(1, 6)
    wanted = sizes[0] @ np.sin(angle) + sizes[1] @ np.cos(angle)
    low, high = wanted.min(axis=1, keepdims=True), wanted.max(axis=1, keepdims=True)
    middle, reach = (LOW + HIGH)[:, None] / 2, 0.8 * (HIGH - LOW)[:, None]
    wanted = middle + reach * ((wanted - low) / (high - low) - 0.5)
    speed = np.gradient(wanted, STEP, axis=1)
    model = _model(tendon, payload)
    state = mujoco.MjData(model)
    state.qpos[:], state.qvel[:] = wanted[:, 0], speed[:, 0]
    mujoco.mj_forward(model, state)
    summed, torque, rows = state.qfrc_bias / GAINS[2], np.zeros(3), []
    for k in range(len(t)):
        motor = COUNT * np.rint(state.qpos * RATIO / COUNT)
        if k % TICK == 0:
            error = wanted[:, k] - motor / RATIO
            summed = summed + error * STEP * TICK
            torque = GAINS[0] * error + GAINS[1] * (speed[:, k] - state.qvel) + GAINS[2] * summed
        if k % round(1 / (RATE * STEP)) == 0:
            current = (torque + NOISE * random.normal(size=3)) / (RATIO * CONSTANT)
            rows.append(np.r_[t[k], motor, current])
        state.ctrl[:] = torque
        mujoco.mj_step(model, state)
    return dict(zip(("t", "qm1", "qm2", "qm3", "i1", "i2", "i3"), np.array(rows).T, strict=True))
