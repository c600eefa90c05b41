"""URDF: efforts, mass matrix and the place of every link are those of Pinocchio, coordinates the source's."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from importing_support import against_pinocchio

import modelgen as mg

MODELS = Path(__file__).parent / "models"
ROBOTS = Path(sys.prefix) / (
    f"lib/python{sys.version_info.major}.{sys.version_info.minor}/site-packages/cmeel.prefix/share/"
    "example-robot-data/robots"
)


def text(values: np.ndarray) -> str:
    return " ".join(f"{v:.17g}" for v in values)


def link(name: str, rng: np.random.Generator) -> str:
    """A link whose inertia is that of matter."""
    a = rng.normal(size=(3, 3))
    tensor = 0.02 * (np.trace(a @ a.T) * np.eye(3) - a @ a.T)
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = tensor
    return (
        f'<link name="{name}"><inertial><origin xyz="{text(0.1 * rng.normal(size=3))}" '
        f'rpy="{text(rng.normal(size=3))}"/><mass value="{rng.uniform(0.5, 3)}"/>'
        f'<inertia ixx="{xx}" ixy="{xy}" ixz="{xz}" iyy="{yy}" iyz="{yz}" izz="{zz}"/></inertial></link>'
    )


def joint(name: str, kind: str, parent: str, child: str, rng: np.random.Generator, axis: str = "") -> str:
    given = axis or text(rng.normal(size=3))
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{text(0.3 * rng.normal(size=3))}" rpy="{text(rng.normal(size=3))}"/>'
        f'<axis xyz="{given}"/><limit lower="-3" upper="3" velocity="2" effort="9"/></joint>'
    )


def tree(kinds: str, parents: list[int], seed: int, axis: str = "") -> str:
    """Joint j of kind r, p or f between link parents[j] and link j + 1."""
    rng = np.random.default_rng(seed)
    words = {"r": "revolute", "c": "continuous", "p": "prismatic", "f": "fixed"}
    parts = [link(f"l{k}", rng) for k in range(len(kinds) + 1)]
    parts += [
        joint(f"j{k + 1}", words[kind], f"l{parents[k]}", f"l{k + 1}", rng, axis)
        for k, kind in enumerate(kinds)
    ]
    return f'<robot name="made">{"".join(parts)}</robot>'


def saved(folder: Path, content: str) -> Path:
    path = folder / "robot.urdf"
    path.write_text(content, encoding="utf-8")
    return path


TREES = {
    "chain": ("rrrr", [0, 1, 2, 3]),
    "slides": ("prpr", [0, 1, 2, 3]),
    "two slides at the end": ("rpp", [0, 1, 2]),
    "fixed links": ("frfrf", [0, 1, 2, 3, 4]),
    "branches": ("rrrprc", [0, 1, 1, 1, 0, 5]),
    "branch behind a fixed link": ("rfrpr", [0, 1, 2, 2, 0]),
}


@pytest.mark.parametrize("name", TREES)
def test_a_tree_of_any_axes_moves_as_in_pinocchio(name: str, tmp_path: Path) -> None:
    kinds, parents = TREES[name]
    path = saved(tmp_path, tree(kinds, parents, seed=len(name)))
    against_pinocchio(path, mg.import_robot(path))


@pytest.mark.parametrize("axis", ["1 0 0", "0 -1 0"])
def test_axes_at_the_frames_own_directions_move_as_in_pinocchio(axis: str, tmp_path: Path) -> None:
    path = saved(tmp_path, tree("rrpr", [0, 1, 2, 3], 3, axis).replace('rpy="', 'rpy="0 0 0" was="'))
    against_pinocchio(path, mg.import_robot(path))


def test_axes_that_are_parallel_by_a_hair_keep_lengths_small_and_the_motion(tmp_path: Path) -> None:
    rng = np.random.default_rng(4)
    parts = [link(f"l{k}", rng) for k in range(4)]
    for k, axis in enumerate(("0 0 1", "0.0002 0 1", "0 1 0")):
        parts.append(joint(f"j{k + 1}", "revolute", f"l{k}", f"l{k + 1}", rng, axis).replace("rpy=", "was="))
    path = saved(tmp_path, f"<robot name='hair'>{''.join(parts)}</robot>")
    robot = mg.import_robot(path)
    assert any(j.type == "fixed" for j in robot.arm.joints)
    lengths = [value for j in robot.arm.joints for value in (j.d, j.r, j.b)]
    assert max(abs(float(x)) for x in lengths) < 2.0
    against_pinocchio(path, robot)


def test_a_held_joint_and_a_tip_leave_the_rest_as_in_pinocchio(tmp_path: Path) -> None:
    path = saved(tmp_path, tree("rrrpr", [0, 1, 2, 2, 4], 6))
    robot = mg.import_robot(path, tip="l5", lock={"j2": 0.4}, name="held")
    assert list(robot.joints) == ["j1", "j4", "j5"]
    assert robot.arm.name == "held"
    assert any("j3" in remark for remark in robot.remarks)
    against_pinocchio(path, robot, {"j2": 0.4})


def test_limits_friction_and_gear_come_along(tmp_path: Path) -> None:
    content = tree("rp", [0, 1], 7).replace("</joint>", "<dynamics damping='0.5' friction='0.2'/></joint>")
    gear = "<transmission name='t'><joint name='j1'/><actuator name='m'><mechanicalReduction>50"
    content = content.replace("</robot>", f"{gear}</mechanicalReduction></actuator></transmission></robot>")
    robot = mg.import_robot(saved(tmp_path, content))
    first, second = robot.arm.joints
    assert (first.limits.position, first.limits.velocity, first.limits.effort) == ((-3, 3), 2, 9)
    model = mg.build_model(robot.arm)
    at = [np.array([[v, 0.0]]) for v in (0.3, 0.0, 0.0)]
    moving = [at[0], np.array([[1.5, 2.0]]), at[2]]
    parameters = np.asarray(model.nominal)
    gains = model.functions["drive_gain"](at[0])
    # what turns its sign with the speed is friction: 0.5 v + 0.2
    back = [at[0], -moving[1], at[2]]
    forth, other = (model.functions["inverse_dynamics"](*x, parameters) * gains for x in (moving, back))
    assert (forth - other)[0] / 2 == pytest.approx([0.5 * 1.5 + 0.2, 0.5 * 2 + 0.2])
    assert gains[0] == pytest.approx([50, 1])
    assert second.type == "prismatic"


def test_rounded_right_angles_become_right_with_a_remark(tmp_path: Path) -> None:
    content = tree("rr", [0, 1], 8, "0 0 1")
    parts = content.split("<joint")
    parts[2] = parts[2].replace("rpy=", 'rpy="1.5708 0 0" was=')
    path = saved(tmp_path, "<joint".join(parts))
    robot = mg.import_robot(path)
    assert "alpha: pi/2" in robot.text
    assert any("1.5708" in remark for remark in robot.remarks)
    kept = mg.import_robot(path, exact=True)
    assert kept.remarks == ()
    against_pinocchio(path, kept)


def test_an_imported_ur10e_costs_what_the_one_made_by_hand_does() -> None:
    root = Path(__file__).parents[2]
    by_hand = mg.load_arms(root / "benchmarks" / "arms.yaml")["ur10e_bench"]
    imported = mg.import_robot(MODELS / "ur10e.urdf").arm
    counts = []
    for arm in (by_hand, imported):
        by_name = {f.name: f.operations for f in mg.build_model(arm).built.functions}
        counts.append(sum(by_name["inverse_dynamics"][k] for k in ("mul", "add", "neg")))
    assert counts[1] <= 1.02 * counts[0]


def test_the_ur10e_moves_as_in_pinocchio() -> None:
    against_pinocchio(MODELS / "ur10e.urdf", mg.import_robot(MODELS / "ur10e.urdf", exact=True))


PUBLISHED = ("panda", "kinova", "z1", "xarm7", "double_pendulum", "TwoDofs", "ur5_robot", "finger_edu")


@pytest.mark.parametrize("stem", PUBLISHED)
@pytest.mark.skipif(not ROBOTS.exists(), reason="the PyPI package example-robot-data is not installed")
def test_published_robots_move_as_in_pinocchio(stem: str) -> None:
    path = next(iter(sorted(ROBOTS.rglob(f"{stem}.urdf"))))
    mimics = {"panda": {"panda_finger_joint2": 0.0}}.get(stem)
    against_pinocchio(path, mg.import_robot(path, lock=mimics, exact=True), mimics)
