"""Exported models against the simulators that read them."""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np
from numpy.typing import NDArray

import modelgen as mg
from modelgen.exporting.states import States
from modelgen.exporting.values import nominal, standard_of

Array = NDArray[np.float64]
SAMPLES = 200


def only_exact(arm: mg.Arm, model: mg.ExportedModel) -> mg.Arm:
    """The arm without the effects that the file does not have exactly."""
    others = {(row.effect, row.joint) for row in model.rows if row.status != "exact"}
    joints = tuple(
        replace(j, effects=tuple(use for use in j.effects if (use.name, j.name) not in others))
        for j in arm.joints
    )
    return replace(
        arm, joints=joints, effects=tuple(use for use in arm.effects if (use.name, None) not in others)
    )


class Motion:
    """States within the limits, inputs, and the accelerations that the arm's own functions give (N, n)."""

    def __init__(self, arm: mg.Arm) -> None:
        self.model = mg.build_model(arm)
        known = standard_of(nominal(arm))
        parameters = np.array([known[p.name] for p in self.model.built.standard])
        states = States(arm)
        self.q, self.dq, self.ddq = (x[:SAMPLES] for x in (states.q, states.dq, states.ddq))
        functions, state = self.model.functions, {}
        if self.model.built.states:
            state = {"state": np.zeros((SAMPLES, len(self.model.built.states)))}
        self.inputs: Array = functions["inverse_dynamics_standard"](
            q=self.q, dq=self.dq, ddq=self.ddq, parameters=parameters, **state
        )
        self.efforts: Array = self.inputs * functions["drive_gain"](self.q)
        self.accelerations: Array = functions["forward_dynamics_standard"](
            q=self.q, dq=self.dq, input=self.inputs, parameters=parameters, **state
        )


def mujoco_accelerations(text: str, motion: Motion) -> Array:
    """Of MuJoCo in the same states with the same inputs (N, n)."""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    found = np.zeros_like(motion.accelerations)
    assert model.nv == model.nu == motion.q.shape[1]
    for k in range(SAMPLES):
        data.qpos[:], data.qvel[:], data.ctrl[:] = motion.q[k], motion.dq[k], motion.inputs[k]
        mujoco.mj_forward(model, data)
        found[k] = data.qacc
    return found


def close(ours: Array, theirs: Array) -> None:
    """Equal to 1e-9 of the largest."""
    assert np.abs(ours - theirs).max() <= 1e-9 * np.abs(theirs).max()
