"""Where the base stands and where tools are: read from the description, kept by poses and Jacobian."""

from dataclasses import replace

import numpy as np
import pytest
from witness.arms import build
from witness.compare import agree

from modelgen.description import Arm, loads
from modelgen.errors import InputError
from modelgen.functions import Options
from modelgen.generation.canonical import description_hash

TEXT = """\
schema: 1
convention: khalil_kleinfinger
arms:
  arm:
    base: {xyz: [1, -2, 300 mm], rpy: [20 deg, -0.3, pi/2]}
    joints:
      - {name: j1, alpha: 0.4, r: 0.2}
      - {name: j2, type: prismatic, alpha: pi/2, d: 0.3}
      - {name: j3, alpha: -pi/2, d: 0.1, r: 0.4}
    tools:
      camera: {link: j2, matrix: [[0, -1, 0, 0.1], [1, 0, 0, 0.2], [0, 0, 1, 0.3], [0, 0, 0, 1]]}
      tcp: {link: j3, xyz: [0.01, 0, 0.2], rpy: [0, pi, 0.5]}
"""
Q = np.random.default_rng(3).uniform(-2, 2, (5, 3))


def read(text: str = TEXT) -> Arm:
    return loads(text)["arm"]


def about(axis: int, angle: float) -> np.ndarray:
    """Turn about one axis, by the exponential of its generator."""
    turn = np.eye(3)[[axis - 2, axis - 1]]
    k = np.outer(turn[1], turn[0]) - np.outer(turn[0], turn[1])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * (k @ k)


def homogeneous(turn: np.ndarray, place: list[float]) -> np.ndarray:
    return np.block([[turn, np.array(place)[:, None]], [np.zeros(3), np.ones(1)]])


BASE = homogeneous(about(2, np.pi / 2) @ about(1, -0.3) @ about(0, np.radians(20)), [1, -2, 0.3])
TCP = homogeneous(about(2, 0.5) @ about(1, np.pi), [0.01, 0, 0.2])
CAMERA = np.array([[0, -1, 0, 0.1], [1, 0, 0, 0.2], [0, 0, 1, 0.3], [0, 0, 0, 1]])


def test_poses_are_those_of_the_world_and_tools_follow_the_links() -> None:
    arm = read()
    bare = build(replace(arm, base=None, tools=()))("forward_kinematics", Q)
    links = [BASE @ np.asarray(pose).reshape(-1, 4, 4) for pose in bare]
    found = build(arm)("forward_kinematics", Q)
    assert len(found) == 5
    for pose, expected in zip(found, [*links, links[1] @ CAMERA, links[2] @ TCP], strict=True):
        agree(np.asarray(pose).reshape(-1, 4, 4), expected, 1e-12)


@pytest.mark.parametrize("tool", ["tcp", "camera"])
def test_the_jacobian_of_a_tool_is_how_it_moves(tool: str) -> None:
    built = build(read(), Options(without=frozenset({"drives", "effects"}), jacobian_link=tool))
    k = ("camera", "tcp").index(tool) + 3

    def pose(q: np.ndarray) -> np.ndarray:
        return np.asarray(built("forward_kinematics", q[None])[k]).reshape(4, 4)

    step = 1e-6
    for q, found in zip(Q, built("jacobian", Q), strict=True):
        for n, change in enumerate(step * np.eye(3)):
            rate = (pose(q + change) - pose(q - change)) / (2 * step)
            spin = rate[:3, :3] @ pose(q)[:3, :3].T
            agree([found[:, n]], [[*rate[:3, 3], spin[2, 1], spin[0, 2], spin[1, 0]]], 1e-8)


def test_what_moves_the_arm_knows_nothing_of_base_and_tools() -> None:
    arm = read()
    bare = build(replace(arm, base=None, tools=()))
    own = build(arm)
    for name, function in own.functions.items():
        if name not in ("forward_kinematics", "jacobian"):
            assert function.program == bare.functions[name].program


def test_an_arm_without_them_has_the_hash_that_it_had() -> None:
    """So that generated files, which show it, stay byte for byte."""
    arm = read()
    bare = replace(arm, base=None, tools=())
    assert len({description_hash(a) for a in (arm, bare, replace(bare, base=arm.base))}) == 3
    lines = [line for line in TEXT.splitlines() if "base:" not in line]
    assert description_hash(bare) == description_hash(read("\n".join(lines[: lines.index("    tools:")])))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("link: j3", "link: j4", "arm.tools.tcp.link: found 'j4', which is no joint of this arm"),
        ("tcp:", "j3:", "arm.tools.j3: a joint is called the same"),
        ("[0, 0, 0, 1]]", "[0, 0, 1, 1]]", "arm.tools.camera.matrix.3: its last row is not 0, 0, 0, 1"),
        ("[1, 0, 0, 0.2]", "[-1, 0, 0, 0.2]", "are no rotation"),  # a reflection
        ("[0, 0, 1, 0.3]", "[0, 0, 2, 0.3]", "are no rotation"),
        ("link: j2, matrix", "link: j2, xyz: [0, 0, 1], matrix", "found xyz or rpy beside a matrix"),
        ("rpy: [20 deg", "rpy: [20 mm", "arm.base.rpy.0: found '20 mm', expected an angle"),
        ("base: {xyz", "base: {xzy", "found the unknown key 'xzy'"),
    ],
)
def test_a_mistake_has_one_line(old: str, new: str, message: str) -> None:
    assert old in TEXT
    with pytest.raises(InputError) as error:
        read(TEXT.replace(old, new))
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_an_impossible_inertia_is_kept_where_the_description_says_so() -> None:
    link = "    links: {j1: {mass: 1, com: [0, 0, 0], inertia: [-1, 0, 0, 1, 0, 1]}}\n"
    with pytest.raises(InputError, match="no body has this inertia"):
        read(TEXT + link)
    kept = read(TEXT + link.replace("}}", ", as_given: true}}"))
    assert kept.links[0] is not None
    assert kept.links[0].inertia[0] == -1
