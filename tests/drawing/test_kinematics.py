"""The page of a drawing computes what modelgen computes."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from drawing_support import evaluated

import modelgen as mg
from modelgen.drawing import page, scene, start
from modelgen.numeric import Array

# Every kind of joint and drive; a tree, a base in a world, tools, figures by name, a joint held.
ARMS = """
schema: 1
convention: khalil_kleinfinger
arms:
  loader:
    gravity: [0, 0, -9.81]
    base: {xyz: [0.3, -0.1, 0.7], rpy: [0.2, pi, -0.4]}
    symbols: {reach: 0.62, tilt: 0.3}
    locked: {wrist: 40 deg}
    joints:
      - name: swing
        gamma: tilt
        b: 0.05
        alpha: pi/2
        d: 0.1
        r: 0.2
        drive: {type: levered, l1: 0.32, l2: 0.06, length: [0.27, 0.36], motor: [20000, 100], rev: -1,
                offset: 60 deg, torque_constant: 1.0e-3}
        effects: [{actuator_mass: {inertia: 0.1, moment_x: 0.2, moment_y: 0, base_angle: 110 deg}}]
      - {name: pad, type: fixed, alpha: 0.3, d: 0.05, theta: 0.2, r: -0.1}
      - name: boom
        alpha: 0
        d: reach
        r: 0
        drive: {type: slider_crank, lever: 0.1, rod: 0.25, height: 0.03, lead: 0.005, offset: 0.3,
                torque_constant: 0.1}
      - {name: slide, type: prismatic, alpha: pi/2, d: 0.1, theta: 0.4, r: 0.15,
         limits: {position: [-0.1, 0.3]}, drive: {type: direct, ratio: 2*pi/0.01, torque_constant: 0.1}}
      - {name: wrist, alpha: -pi/2, d: 0.02, r: 0.03}
      - {name: side, antecedent: boom, gamma: 100 deg, b: -0.2, alpha: 1.1, d: 0.3, theta: -0.2, r: 0.1}
    tools:
      cup: {link: wrist, xyz: [0.01, -0.02, 0.2], rpy: [0.1, 0.2, 0.3]}
      eye: {link: boom, xyz: [0.2, 0, 0.05]}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("drawing")


@pytest.fixture(scope="module")
def loader(folder: Path) -> mg.Arm:
    path = folder / "arms.yaml"
    path.write_text(ARMS, encoding="utf-8")
    return mg.load_arms(path)["loader"]


def states(arm: mg.Arm, count: int = 12) -> Array:
    """Random coordinates within the limits."""
    rng = np.random.default_rng(5)
    ends = [joint["range"] or [-3.0, 3.0] for joint in scene(arm)["joints"] if joint["coordinate"] >= 0]
    low, high = np.array(ends).T
    return rng.uniform(low, high, (count, len(ends)))


@pytest.mark.parametrize("name", ["loader", "ariane4", "two_fingers"])
def test_frames_tools_and_motors_are_those_of_the_model(name: str, folder: Path, loader: mg.Arm) -> None:
    arm = loader if name == "loader" else mg.load_arms()[name]
    q = states(arm)
    said = (
        f"{q.tolist()}.map((q) => {{ const f = forward(arm, q); "
        "return {poses: [...f.frames.map((x) => x.link), ...f.tools], motors: motors(arm, q)}; })"
    )
    found = evaluated(page(arm), said, folder)
    functions = mg.build_model(arm).functions
    poses = np.array([x["poses"] for x in found]).reshape(len(q), -1, 3, 4)
    model = np.stack(functions["forward_kinematics"](q), axis=1)
    assert poses.shape[1] == len(arm.joints) + len(arm.tools)
    np.testing.assert_allclose(poses, model.reshape(len(q), -1, 4, 4)[:, :, :3], rtol=0, atol=1e-13)
    motors = functions["motor_from_joint"](q, 0 * q, 0 * q)[0]
    np.testing.assert_allclose(np.array([x["motors"] for x in found]), motors, rtol=1e-12, atol=1e-9)


def test_linkages_have_the_lengths_of_the_description(folder: Path, loader: mg.Arm) -> None:
    """Law of cosines for the lever, the slider-crank's rod and nut by the motor's turns."""
    q = states(loader)
    pins = "(i) => arm.joints[i].drive.bars.map((b) => run(b.pins, q[i ? 1 : 0]))"
    said = f"{q.tolist()}.map((q) => [0, 2].map({pins}))"
    found = evaluated(page(loader), said, folder)
    motors = mg.build_model(loader).functions["motor_from_joint"](q, 0 * q, 0 * q)[0]
    for (lever, crank), turned in zip(found, motors, strict=True):
        l1, l2, actuator = (np.hypot(b[2] - b[0], b[3] - b[1]) for b in lever)
        length = 0.27 + (turned[0] - 20000) / (100 - 20000) * (0.36 - 0.27)
        np.testing.assert_allclose([l1, l2, actuator], [0.32, 0.06, length], atol=1e-12)
        assert lever[0][2:] == lever[2][:2]  # the actuator stands at the end of l1 and pushes that of l2
        assert lever[1][2:] == lever[2][2:]
        arms = [np.hypot(b[2] - b[0], b[3] - b[1]) for b in crank[:2]]
        np.testing.assert_allclose(arms, [0.1, 0.25], atol=1e-12)
        np.testing.assert_allclose(crank[1][2:], [turned[1] * 0.005 / (2 * np.pi), 0.03], atol=1e-12)
        assert crank[2][0] - 1e-12 <= crank[1][2] <= crank[2][2] + 1e-12  # the nut is on its screw


def test_an_effect_says_where_an_actuator_stands(loader: mg.Arm) -> None:
    assert scene(loader)["joints"][0]["drive"]["direction"] == pytest.approx(np.radians(110))
    assert scene(mg.load_arms()["ariane4"])["joints"][0]["drive"]["direction"] is None


def test_an_even_ellipsoid_is_found_from_its_inertia(folder: Path, loader: mg.Arm) -> None:
    half = np.array([0.1, 0.25, 0.4])
    turn, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    squares = half**2
    inertia = turn @ np.diag(7.0 / 5 * (squares.sum() - squares)) @ turn.T  # of an even ellipsoid of 7 kg
    six = inertia[np.triu_indices(3)].tolist()
    wrong = [1.0, 0, 0, 1.0, 0, 2.5]
    said = f"[{json.dumps(six)}, {wrong}].map((inertia) => ellipsoid({{mass: 7, inertia}}))"
    even, none = evaluated(page(loader), said, folder)
    np.testing.assert_allclose(sorted(even["half"]), half, rtol=1e-10)
    axes = np.array(even["axes"])  # in columns
    back = axes @ np.diag(np.array(even["half"]) ** 2) @ axes.T
    np.testing.assert_allclose(back, turn @ np.diag(squares) @ turn.T, atol=1e-12)
    assert even["real"]
    assert not none["real"]  # 2.5 is more than 1 + 1


def test_an_arm_is_drawn_at_zero_or_within_its_limits(loader: mg.Arm) -> None:
    at = dict(zip(("j1", "j2", "j3"), start(mg.load_arms()["ariane4"]), strict=True))
    assert at["j1"] == 0.0
    assert at["j2"] == pytest.approx(np.radians((7 + 94) / 2), abs=1e-5)
    low, high = scene(loader)["joints"][0]["range"]  # the stroke's, where there are no limits
    assert low <= start(loader)[0] <= high
