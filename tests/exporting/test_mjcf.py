"""An exported MJCF moves in MuJoCo as the generated functions say."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest
from exporting_support import Motion, close, mujoco_accelerations, only_exact

import modelgen as mg
from modelgen.exporting.states import States

SHIPPED = mg.load_arms(Path(__file__).parents[2] / "arms.yaml")


@pytest.mark.parametrize("name", SHIPPED)
def test_a_shipped_arm_accelerates_as_its_equations_say(name: str) -> None:
    arm = only_exact(SHIPPED[name], mg.export(SHIPPED[name], to="mjcf"))
    model = mg.export(arm, to="mjcf")
    assert {row.status for row in model.rows} <= {"exact"}
    motion = Motion(arm)
    close(mujoco_accelerations(model.text, motion), motion.accelerations)


@pytest.mark.parametrize("name", ["gravity_arm", "ariane4", "screw_axis"])
def test_dry_friction_of_joints_that_slide_is_that_of_the_equations(name: str) -> None:
    arm = SHIPPED[name]
    model = mg.export(arm, to="mjcf")
    assert {row.status for row in model.rows} == {"exact", "approximated"}
    motion = Motion(arm)
    simulator = mujoco.MjModel.from_xml_string(model.text)
    data, found = mujoco.MjData(simulator), np.zeros_like(motion.efforts)
    full = np.zeros((simulator.nv, simulator.nv))
    for k, (q, dq, ddq) in enumerate(zip(motion.q, motion.dq, motion.ddq, strict=True)):
        data.qpos[:], data.qvel[:] = q, dq
        mujoco.mj_fwdPosition(simulator, data)
        mujoco.mj_fwdVelocity(simulator, data)
        mujoco.mj_fullM(simulator, data, full)
        dry = simulator.dof_frictionloss * np.sign(dq)
        pull = simulator.tendon_frictionloss * np.sign(data.ten_velocity)
        along = np.zeros((simulator.ntendon, simulator.nv))
        if len(along):
            rows = simulator.ten_J_rownnz, simulator.ten_J_rowadr, simulator.ten_J_colind
            mujoco.mju_sparse2dense(along, data.ten_J, *rows)
        found[k] = full @ ddq + data.qfrc_bias - data.qfrc_passive + dry + along.T @ pull
    close(found, motion.efforts)


MANY = """
schema: 1
convention: khalil_kleinfinger
arms:
  many:
    gravity: [1, -2, -9]
    base: {xyz: [0.1, 0.2, 0.3], rpy: [0.3, -0.2, 1]}
    locked: {held: 0.3}
    effects: [{payload_change: {mass: 0.4, x: 0.1, y: -0.05, z: 0.2}}, {base_tilt: {x: 0.1}}]
    tools: {tip: {link: slide, xyz: [0, 0.1, 0.2], rpy: [1, 0, 0.5]}}
    joints:
      - name: turn
        alpha: 0.4
        d: 0.1
        r: 0.2
        theta: 0.7
        drive: {type: direct, ratio: -40, torque_constant: 0.07}
        effects:
          - viscous_friction: {coefficient: 2.0e-3}
          - friction_offset: {offset: 0.02}
          - torque_ripple: {sine: 0.05, cosine: -0.02, harmonic: 4}
          - presliding: {magnitude: 0.1, distance: 0.3}
          - drive_inertia: {inertia: 3.0e-4}
          - spring: {stiffness: 30, rest: 0.4}
          - encoder_offset: {offset: 0.05}
          - drive_gain_error: {error: 0.1}
      - {name: held, alpha: 0.2, d: 0.1, r: 0.1, drive: {type: direct, ratio: 9, torque_constant: 1}}
      - name: lift
        alpha: 1.3
        d: 0.05
        r: -0.1
        theta: 0.5
        antecedent: turn
        gamma: 0.3
        b: 0.2
        drive: {type: levered, l1: 0.4, l2: 0.1, length: [0.36, 0.46], motor: [9000, 0], rev: -1,
                offset: 1.2, torque_constant: 2.0e-3}
        effects:
          - viscous_friction: {coefficient: 1.0e-6}
          - nonlinear_viscous_friction: {coefficient: 1.0e-5, exponent: 2, scale: 100}
          - friction_offset: {offset: 1.0e-3}
          - torque_ripple: {sine: 4.0e-4, cosine: 6.0e-4, harmonic: 3, revolution: 1000}
          - drive_inertia: {inertia: 3.0e-8}
          - spring: {stiffness: 5, preload: -2}
          - lever_geometry: {l2: 0.003}
      - name: swing
        alpha: -1
        d: 0.3
        r: 0
        drive: {type: none}
        effects:
          - viscous_friction: {coefficient: 0.3}
          - spring: {stiffness: 0, preload: 0.7}
          - nonlinear_viscous_friction: {coefficient: 0.2, exponent: 3, scale: 0.5}
          - transmission_coupling: {inertia: 0.02, viscous: 0.1, dry: 0, other: 1, ratio: -1.5}
      - {name: edge, type: fixed, alpha: 0.3, d: 0.2, r: 0.1}
      - name: slide
        type: prismatic
        alpha: 0.6
        d: 0.1
        theta: 0.3
        r: 0.2
        limits: {position: [-0.2, 0.3], effort: 900}
        drive: {type: direct, ratio: 2*pi/0.01, torque_constant: 0.05, current: 30}
        effects: [{viscous_friction: {coefficient: 1.0e-3}}, {drive_inertia: {inertia: 1.0e-5}}]
    links:
      turn: {mass: 3, com: [0.1, 0.02, -0.03], inertia: [0.03, 0.001, -0.002, 0.05, 0.003, 0.04]}
      held: {mass: 0, com: [0, 0, 0], inertia: [0, 0, 0, 0, 0, 0]}
      lift: {mass: 4, com: [0.05, 0.1, 0.02], inertia: [0.04, 0.001, -0.002, 0.03, 0.003, 0.05]}
      swing: {mass: 2, com: [0.1, 0, 0.04], inertia: [0.02, 0, 0, 0.03, 0, 0.02]}
      edge: {mass: 0.5, com: [0, 0.1, 0], inertia: [0.002, 0, 0, 0.001, 0, 0.002]}
      slide: {mass: 1, com: [0, 0, 0.1], inertia: [0.01, 0, 0, 0.01, 0, 0.002]}
"""


@pytest.fixture(scope="module")
def many(tmp_path_factory: pytest.TempPathFactory) -> mg.Arm:
    path = tmp_path_factory.mktemp("arms") / "arms.yaml"
    path.write_text(MANY, encoding="utf-8")
    return mg.load_arms(path)["many"]


def test_every_kind_of_joint_and_effect_that_mujoco_knows_is_exact(many: mg.Arm) -> None:
    model = mg.export(many, to="mjcf")
    assert {row.status for row in model.rows} == {"exact"}
    motion = Motion(many)
    close(mujoco_accelerations(model.text, motion), motion.accelerations)


def test_what_was_exported_is_imported_with_its_effects(many: mg.Arm, tmp_path: Path) -> None:
    mg.export(many, to="mjcf", out=tmp_path / "arm.xml")
    robot = mg.import_robot(tmp_path / "arm.xml", exact=True)
    assert robot.remarks == ()
    again = mg.export(robot.arm, to="mjcf")
    assert {row.status for row in again.rows} == {"exact"}
    motion = Motion(many)
    close(mujoco_accelerations(again.text, motion), motion.accelerations)


def test_frames_and_tools_stand_where_the_arm_has_them(many: mg.Arm) -> None:
    model = mujoco.MjModel.from_xml_string(mg.export(many, to="mjcf").text)
    data = mujoco.MjData(model)
    q = States(many).q[3]
    data.qpos[:] = q
    mujoco.mj_kinematics(model, data)
    poses = mg.build_model(many).functions["forward_kinematics"](q=q)
    assert len(poses) == len(many.joints) + len(many.tools)
    for joint, pose in zip(many.joints, poses, strict=False):
        body = data.body(joint.name)
        close(np.append(body.xpos, body.xmat), np.append(pose[:3, 3], pose[:3, :3]))
    site = data.site("tip")
    close(np.append(site.xpos, site.xmat), np.append(poses[-1][:3, 3], poses[-1][:3, :3]))


def test_a_joint_may_be_called_as_the_ground_is() -> None:
    arm = SHIPPED["gravity_link1"].without_effects()
    named = replace(arm, joints=(replace(arm.joints[0], name="world"),))
    model = mujoco.MjModel.from_xml_string(mg.export(named, to="mjcf").text)
    assert model.joint("world").id == 0
