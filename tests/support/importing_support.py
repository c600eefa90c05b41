"""What an imported arm does against what Pinocchio and MuJoCo make of the source itself."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import mujoco
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

import modelgen as mg

Array = NDArray[np.float64]
SAMPLES = 200


class Arm:
    """The arm's own functions over N states; `names` are the source's, by coordinate."""

    def __init__(self, robot: mg.ImportedRobot, seed: int = 1) -> None:
        self.robot = robot
        model = mg.build_model(robot.arm, derivatives=False)
        assert model.nominal is not None
        self.model = model
        n = len(robot.arm.coordinates)
        rng = np.random.default_rng(seed)
        self.q, self.dq, self.ddq = rng.uniform(-2, 2, (3, SAMPLES, n))
        parameters = np.asarray(model.nominal)
        gains = model.functions["drive_gain"](self.q)
        self.efforts = model.functions["inverse_dynamics"](self.q, self.dq, self.ddq, parameters) * gains
        self.mass = model.functions["mass_matrix"](self.q, parameters)
        poses = model.functions["forward_kinematics"](self.q)
        poses = poses if isinstance(poses, tuple) else (poses,)
        self.poses = dict(zip([joint.name for joint in robot.arm.joints], poses, strict=False))
        own = {own: theirs for theirs, own in robot.joints.items()}
        self.names = [own[robot.arm.joints[i].name] for i in robot.arm.coordinates]

    def links(self) -> dict[str, Array]:
        """Poses (N, 4, 4) of the source's links in the world."""
        return {
            name: frame * np.ones((SAMPLES, 1, 1)) if joint is None else self.poses[joint] @ frame
            for name, (joint, frame) in self.robot.links.items()
        }


def off(ours: Array, theirs: Array) -> float:
    """Largest difference, of the largest or of 1."""
    return float(np.abs(ours - theirs).max() / max(1.0, np.abs(theirs).max()))


def against_pinocchio(path: Path, robot: mg.ImportedRobot, lock: Mapping[str, float] | None = None) -> None:
    """Efforts, mass matrices and poses of every link of a URDF are equal to 1e-9."""
    assert off_pinocchio(path, Arm(robot), lock) <= 1e-9


def off_pinocchio(path: Path, arm: Arm, lock: Mapping[str, float] | None = None) -> float:
    """Largest relative difference of efforts, mass matrices and poses; joints beside the arm's are held."""
    whole = pin.buildModelFromUrdf(str(path))
    at = pin.neutral(whole)
    held = [i for i in range(1, whole.njoints) if whole.names[i] not in arm.names]
    for i in held:
        joint, value = whole.joints[i], (lock or {}).get(whole.names[i], 0.0)
        at[joint.idx_q : joint.idx_q + joint.nq] = (
            [value] if joint.nq == 1 else [np.cos(value), np.sin(value)]
        )
    # not without need: a link that is called as a joint is stops it
    model = pin.buildReducedModel(whole, held, at) if held else whole
    data = model.createData()
    order = [model.joints[model.getJointId(name)].idx_v for name in arm.names]
    links = arm.links()
    efforts, masses = np.zeros_like(arm.efforts), np.zeros_like(arm.mass)
    poses = {name: np.zeros((SAMPLES, 4, 4)) for name in links}
    for k in range(SAMPLES):
        q, v, a = np.zeros(model.nq), np.zeros(model.nv), np.zeros(model.nv)
        for j, name in enumerate(arm.names):
            joint, value = model.joints[model.getJointId(name)], arm.q[k, j]
            q[joint.idx_q : joint.idx_q + joint.nq] = (
                [value] if joint.nq == 1 else [np.cos(value), np.sin(value)]
            )
            v[joint.idx_v], a[joint.idx_v] = arm.dq[k, j], arm.ddq[k, j]
        inertias = pin.crba(model, data, q)
        full = np.triu(inertias) + np.triu(inertias, 1).T
        masses[k] = full[np.ix_(order, order)]
        resistance = model.damping * v + model.upperDryFrictionLimit * np.sign(v)
        efforts[k] = (pin.rnea(model, data, q, v, a) + resistance)[order]
        pin.framesForwardKinematics(model, data, q)
        for name in links:
            poses[name][k] = data.oMf[model.getFrameId(name, pin.FrameType.BODY)].homogeneous
    found = [off(arm.efforts, efforts), off(arm.mass, masses)]
    return max(*found, *(off(ours, poses[name]) for name, ours in links.items()))


def against_mujoco(text: str, robot: mg.ImportedRobot) -> None:
    """Efforts, mass matrices and poses of every body of an MJCF are equal to 1e-9."""
    assert off_mujoco(text, Arm(robot)) <= 1e-9


def off_mujoco(text: str, arm: Arm) -> float:
    """Largest relative difference of efforts, mass matrices and poses, passive forces taken in."""
    robot = arm.robot
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    joints = [mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name) for name in arm.names]
    dofs = [model.jnt_dofadr[j] for j in joints]
    bodies = {name: mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name) for name in robot.links if name}
    bodies = {name: number for name, number in bodies.items() if number >= 0}
    sites = {name: mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, name) for name in robot.links}
    links = arm.links()
    efforts, masses = np.zeros_like(arm.efforts), np.zeros_like(arm.mass)
    poses = {name: np.tile(np.eye(4), (SAMPLES, 1, 1)) for name in links}
    for k in range(SAMPLES):
        data.qpos[:], data.qvel[:], data.qacc[:] = model.qpos0, 0.0, 0.0
        for j, joint in enumerate(joints):
            data.qpos[model.jnt_qposadr[joint]] = arm.q[k, j]
            data.qvel[dofs[j]], data.qacc[dofs[j]] = arm.dq[k, j], arm.ddq[k, j]
        wanted = data.qacc.copy()
        mujoco.mj_fwdPosition(model, data)
        mujoco.mj_fwdVelocity(model, data)
        full = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, full)
        dry = model.dof_frictionloss * np.sign(data.qvel)
        forces = full @ wanted + data.qfrc_bias - data.qfrc_passive + dry
        efforts[k], masses[k] = forces[dofs], full[np.ix_(dofs, dofs)]
        for name in links:
            if name in bodies:
                poses[name][k, :3, 3] = data.xpos[bodies[name]]
                poses[name][k, :3, :3] = data.xmat[bodies[name]].reshape(3, 3)
            elif sites[name] >= 0:
                poses[name][k, :3, 3] = data.site_xpos[sites[name]]
                poses[name][k, :3, :3] = data.site_xmat[sites[name]].reshape(3, 3)
    seen = [name for name in links if name in bodies or sites[name] >= 0]
    assert seen
    found = [off(arm.efforts, efforts), off(arm.mass, masses)]
    return max(*found, *(off(links[name], poses[name]) for name in seen))
