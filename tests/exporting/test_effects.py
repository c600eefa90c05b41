"""What a file says of each effect: exact, approximated by how much, or left out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest
from exporting_support import Array

import modelgen as mg
from modelgen.description.objects import EffectUse
from modelgen.exporting.states import States

ARMS = mg.load_arms(Path(__file__).parents[2] / "arms.yaml")


def with_effect(arm: mg.Arm, joint: int, name: str, **values: float) -> mg.Arm:
    """The arm with this effect alone at a joint."""
    bare = arm.without_effects()
    joints = list(bare.joints)
    joints[joint] = replace(joints[joint], effects=(EffectUse(name, values),))
    return replace(bare, joints=tuple(joints))


def row_of(arm: mg.Arm) -> tuple[str, float | None]:
    """Status and largest error of its only effect."""
    (row,) = mg.export(arm, to="mjcf").rows
    return row.status, row.error


def test_a_law_that_mujoco_does_not_have_is_left_out_with_its_size() -> None:
    arm = with_effect(ARMS["gravity_arm"], 1, "asymmetric_viscous_friction", coefficient=2.0)
    status, error = row_of(arm)
    assert status == "left out"
    # at most 1 rad/s where the description has no limit
    assert error == pytest.approx(2.0, rel=0.02)


def test_dry_friction_is_off_at_rest_by_all_of_it() -> None:
    assert row_of(with_effect(ARMS["gravity_arm"], 0, "coulomb_friction", magnitude=0.4)) == (
        "approximated",
        0.4,
    )
    geared = with_effect(ARMS["puma560"], 2, "coulomb_friction", magnitude=0.1)
    assert row_of(geared)[1] == pytest.approx(0.1 * 53.7063)


def test_smoothed_dry_friction_is_off_near_rest() -> None:
    arm = with_effect(ARMS["gravity_arm"], 0, "coulomb_friction", magnitude=0.4, smoothing=0.2)
    status, error = row_of(arm)
    assert status == "approximated"
    assert error == pytest.approx(0.4, rel=0.01)


def test_friction_that_needs_states_is_measured_cold_and_settled() -> None:
    warm = with_effect(ARMS["gravity_arm"], 0, "friction_warm_up", dry=0.3, viscous=0.0, time=60.0, speed=1.0)
    assert row_of(warm) == ("left out", pytest.approx(0.3))
    bristles = with_effect(ARMS["gravity_arm"], 0, "presliding", magnitude=0.3, distance=0.01)
    assert row_of(bristles) == ("exact", 0.0)
    assert mg.export(bristles, to="urdf").rows[0].status == "approximated"


def test_bristles_bend_as_dahl_says() -> None:
    magnitude, distance, ratio = 0.2, 0.5, -62.6111
    arm = with_effect(ARMS["puma560"], 0, "presliding", magnitude=magnitude, distance=distance)
    simulator = mujoco.MjModel.from_xml_string(mg.export(arm, to="mjcf").text)
    data = mujoco.MjData(simulator)
    for bend, speed in ((0.4, 0.01), (0.4, -0.01), (-1.0, 0.02), (0.0, -0.03)):
        # the simulator's state is the deflection
        data.act[:], data.qvel[0] = bend * distance, speed
        mujoco.mj_forward(simulator, data)
        assert data.qfrc_actuator[0] == pytest.approx(-ratio * magnitude * bend, abs=1e-12)
        assert data.act_dot[0] == pytest.approx(ratio * speed - abs(ratio * speed) * bend, abs=1e-12)


def crank_ratio(q: Array) -> Array:
    """Motor turns per turn of a slider-crank of lever 0.1, rod 0.4, height 0.05 and lead 0.01 m."""
    across = 0.05 - 0.1 * np.sin(q)
    slope = -0.1 * np.sin(q) + across * 0.1 * np.cos(q) / np.sqrt(0.4**2 - across**2)
    return np.asarray(slope * 2 * np.pi / 0.01)


def test_a_linkage_that_mujoco_does_not_have_is_approximated_in_its_middle(tmp_path: Path) -> None:
    path = tmp_path / "arms.yaml"
    path.write_text(
        "schema: 1\nconvention: khalil_kleinfinger\narms:\n  crank:\n    joints:\n"
        "      - name: j1\n        alpha: pi/2\n        d: 0\n        r: 0\n"
        "        limits: {position: [60 deg, 120 deg]}\n"
        "        drive: {type: slider_crank, lever: 0.1, rod: 0.4, height: 0.05, lead: 0.01, offset: 0,"
        " torque_constant: 0.1}\n"
        "        effects: [{viscous_friction: {coefficient: 1.0e-3}}]\n"
        "    links: {j1: {mass: 1, com: [0.2, 0, 0], inertia: [0.01, 0, 0, 0.01, 0, 0.01]}}\n",
        encoding="utf-8",
    )
    arm = mg.load_arms(path)["crank"]
    (row,) = mg.export(arm, to="mjcf").rows
    assert row.status == "approximated"
    k1 = crank_ratio(np.radians(np.linspace(60, 120, 601)))
    bound = 1e-3 * np.abs(k1**2 - k1[300] ** 2).max() * 1.0  # rad/s
    assert row.error is not None
    assert 0.8 * bound < row.error <= bound
    states = States(arm)
    simulator = mujoco.MjModel.from_xml_string(mg.export(arm, to="mjcf").text)
    data, off = mujoco.MjData(simulator), []
    for q, dq in zip(states.q[:, 0], states.dq[:, 0], strict=True):
        data.qpos[0], data.qvel[0] = q, dq
        mujoco.mj_forward(simulator, data)
        off.append(-data.qfrc_passive[0] - 1e-3 * crank_ratio(np.array([q]))[0] ** 2 * dq)
    assert row.error == pytest.approx(np.abs(off).max(), rel=1e-9)


def test_an_effect_without_a_value_is_left_out_and_says_so() -> None:
    rows = mg.export(ARMS["puma560"], to="mjcf").rows
    assert {row.effect for row in rows if row.status == "exact"} == {"drive_inertia"}
    others = [row for row in rows if row.status != "exact"]
    assert {(row.status, row.error) for row in others} == {("left out", None)}
    assert all("no value for" in row.text for row in others)


def test_a_delay_is_a_filter_of_the_actuator() -> None:
    arm = with_effect(ARMS["yaw3pitch"], 2, "time_delay", delay=0.04)
    model = mg.export(arm, to="mjcf")
    assert [row.status for row in model.rows] == ["exact"]
    simulator = mujoco.MjModel.from_xml_string(model.text)
    data = mujoco.MjData(simulator)
    data.ctrl[2] = 5.0
    simulator.opt.timestep = 1e-5
    while data.time < 0.04:
        mujoco.mj_step(simulator, data)
    assert data.actuator_force[2] == pytest.approx(5.0 * (1 - np.exp(-1)), rel=1e-3)


def test_a_joint_at_rest_is_held_by_dry_friction() -> None:
    arm = with_effect(ARMS["gravity_link1"], 0, "coulomb_friction", magnitude=40.0)
    simulator = mujoco.MjModel.from_xml_string(mg.export(arm, to="mjcf").text)
    data = mujoco.MjData(simulator)
    data.qpos[0] = 1.0  # its weight pulls with 27 N m
    while data.time < 1.0:
        mujoco.mj_step(simulator, data)
    assert abs(data.qpos[0] - 1.0) < 0.02
