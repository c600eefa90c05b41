"""Exported models against the simulators that read them."""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np
from numpy.typing import NDArray

import modelgen as mg
from modelgen.backends import NumpyFunction
from modelgen.base_parameters import group
from modelgen.effects import described
from modelgen.exporting.states import States
from modelgen.exporting.values import nominal, standard_of
from modelgen.functions import Function
from modelgen.functions.bare import bare
from modelgen.functions.dynamics import Dynamics
from modelgen.functions.nominal import base_of
from modelgen.functions.parametric import standard_values
from modelgen.model.equations import Equations

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


def base_parameters(arm: mg.Arm) -> dict[str, float]:
    """Values by name, without the mark of a sum of several, which fixed links and loads have."""
    equations, known = Equations(described(arm)), standard_of(nominal(arm))
    standard = [known[p.name] for p in equations.standard]
    found = base_of(group(equations), arm, standard)
    return {name.removesuffix("R"): value for name, value in found.items()}


class Motion:
    """States within the limits, inputs, efforts and the accelerations of the arm's own equations (N, n)."""

    def __init__(self, arm: mg.Arm) -> None:
        self.arm = arm
        states, known = States(arm), standard_of(nominal(arm))
        self.q, self.dq, self.ddq = (x[:SAMPLES] for x in (states.q, states.dq, states.ddq))
        e = Equations(described(arm))
        dynamics = Dynamics(e, standard_values(e))
        count, dq = len(e.standard), e.vector("dq")
        self.given = {
            "q": self.q,
            "dq": self.dq,
            "ddq": self.ddq,
            "parameters": np.array([known[p.name] for p in e.standard]),
        }
        self.inputs = self._of(bare("inputs", e, count, dynamics.inverse_dynamics(dq, e.vector("ddq"))))
        self.efforts: Array = self.inputs * self._of(bare("gains", e, count, dynamics.gains()))
        self.given["input"] = self.inputs
        accelerations, _ = dynamics.forward_dynamics(dq, e.vector("input"))
        self.accelerations = self._of(bare("accelerations", e, count, accelerations))

    def _of(self, function: Function) -> Array:
        given = {a.name: self.given.get(a.name, np.zeros(a.size)) for a in function.arguments}
        return np.asarray(NumpyFunction(function)(**given))


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
