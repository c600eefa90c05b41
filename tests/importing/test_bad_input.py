"""What is wrong with a file is said in one line, with the line of the file or the name of the part."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

import modelgen as mg
from modelgen.cli.app import app

LINK = (
    '<link name="{}"><inertial><mass value="1"/>'
    '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="{}"/></inertial></link>\n'
)
JOINT = (
    '<joint name="{}" type="{}"><parent link="{}"/><child link="{}"/><axis xyz="{}"/>'
    '<limit lower="-1" upper="1" velocity="1" effort="1"/>{}</joint>\n'
)


def links(*names: str) -> str:
    return "".join(LINK.format(name, 1) for name in names)


BAD = {
    "no XML": ("<robot>\n<link name='a'>\n</robot>", r":3:\d+.*this is no XML: mismatched tag"),
    "missing link": (
        links("a") + JOINT.format("j", "revolute", "a", "b", "0 0 1", ""),
        "there is no link 'b'",
    ),
    "no axis": (
        links("a", "b") + JOINT.format("j", "revolute", "a", "b", "0 0 0", ""),
        "j: its axis is zero",
    ),
    "floating": (
        links("a", "b") + JOINT.format("j", "floating", "a", "b", "0 0 1", ""),
        r":4:\d+: joint j is floating",
    ),
    "planar": (links("a", "b") + JOINT.format("j", "planar", "a", "b", "0 0 1", ""), "joint j is planar"),
    "mimic": (
        links("a", "b", "c")
        + JOINT.format("j", "revolute", "a", "b", "0 0 1", "")
        + JOINT.format("k", "revolute", "b", "c", "0 0 1", '<mimic joint="j"/>'),
        r":6:\d+: joint k mimics j",
    ),
    "loop": (
        links("a", "b", "c")
        + JOINT.format("j", "revolute", "a", "c", "0 0 1", "")
        + JOINT.format("k", "revolute", "b", "c", "0 0 1", ""),
        "link c is carried by the joints j and k",
    ),
    "loop beside the arm": (
        links("a", "b", "c", "d")
        + JOINT.format("j", "revolute", "a", "b", "0 0 1", "")
        + JOINT.format("k", "revolute", "c", "d", "0 0 1", "")
        + JOINT.format("l", "revolute", "d", "c", "0 0 1", ""),
        "the joints k, l carry each other",
    ),
    "negative mass": (
        links("a", "b").replace('mass value="1"', 'mass value="-1"')
        + JOINT.format("j", "revolute", "a", "b", "0 0 1", ""),
        r":2:\d+: link a: found a mass of -1 kg",
    ),
    "xacro": ('<xacro:arm xmlns:xacro="x"/>', "xacro FILE > robot.urdf"),
    "a word for a number": (
        links("a", "b") + JOINT.format("j", "revolute", "a", "b", "0 0 up", ""),
        "found 'up', expected a number",
    ),
    "limits the wrong way round": (
        (links("a", "b") + JOINT.format("j", "revolute", "a", "b", "0 0 1", "")).replace('"-1"', '"2"'),
        r":4:\d+.*found 2 to 1, expected the lower end first",
    ),
    "entities": ('<!DOCTYPE r [<!ENTITY a "b">]>', "DOCTYPE|no XML"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_one_line(name: str, tmp_path: Path) -> None:
    content, message = BAD[name]
    path = tmp_path / "bad.urdf"
    path.write_text(content if "<robot" in content else f"<robot name='r'>\n{content}</robot>", "utf-8")
    with pytest.raises(mg.InputError, match=message) as error:
        mg.import_robot(path)
    assert "\n" not in str(error.value).strip()


def test_an_inertia_of_no_matter_is_kept_with_a_remark(tmp_path: Path) -> None:
    path = tmp_path / "r.urdf"
    content = links("a") + LINK.format("arm", -0.25) + JOINT.format("j", "revolute", "a", "arm", "0 0 1", "")
    path.write_text(f"<robot name='r'>{content}</robot>", "utf-8")
    robot = mg.import_robot(path)
    assert any("link arm" in remark and "-0.25" in remark for remark in robot.remarks)
    assert "as_given: true" in robot.text


@pytest.mark.parametrize(
    ("kind", "more", "limit", "remark"),
    [
        ("revolute", '<origin xyz="0 0 350"/>', "-1", "a length of 350 m: is the source in millimetres?"),
        ("revolute", "", "-180", "limits of -180 to 1 rad: is the source in degrees?"),
        ("prismatic", "", "-500", "limits of -500 to 1 m: is the source in millimetres?"),
    ],
)
def test_what_looks_like_another_unit_is_kept_with_a_remark(
    kind: str, more: str, limit: str, remark: str, tmp_path: Path
) -> None:
    path = tmp_path / "r.urdf"
    content = links("a", "b") + JOINT.format("j", kind, "a", "b", "0 0 1", more).replace('"-1"', f'"{limit}"')
    path.write_text(f"<robot name='r'>{content}</robot>", "utf-8")
    robot = mg.import_robot(path)
    assert [text for text in robot.remarks if remark in text] == [f"joint j: found {remark}"]
    (joint,) = robot.arm.joints
    assert joint.limits.position == (float(limit), 1.0)
    assert float(joint.r) == (350.0 if more else 0.0)


def test_the_command_writes_what_the_function_gives_and_leaves_what_is_there(tmp_path: Path) -> None:
    source, out = Path(__file__).parent / "models" / "ur10e.urdf", tmp_path / "arm.yaml"
    words = [
        "import",
        str(source),
        "--tip",
        "wrist_1_link",
        "--lock",
        "elbow_joint=90 deg",
        "--name",
        "stub",
    ]
    done = CliRunner().invoke(app, [*words, "-o", str(out), "--json"])
    assert done.exit_code == 0, done.output
    robot = mg.import_robot(source, tip="wrist_1_link", lock={"elbow_joint": 1.5707963267948966}, name="stub")
    assert out.read_text("utf-8") == robot.text
    assert json.loads(done.stdout) == json.loads(json.dumps(robot.to_json()))
    assert list(mg.load_arms(out)) == ["stub"]
    again = CliRunner().invoke(app, [*words, "-o", str(out)])
    assert again.exit_code == 2
    assert "exists and is left as it is" in again.stderr


def test_a_joint_that_is_locked_outside_its_range_is_remarked_on() -> None:
    source = Path(__file__).parent / "models" / "ur10e.urdf"
    robot = mg.import_robot(source, lock={"elbow_joint": 9.0})
    assert [r for r in robot.remarks if "locked at 9, outside its range -3.14159 to 3.14159" in r]
    assert not [r for r in mg.import_robot(source, lock={"elbow_joint": 1.0}).remarks if "locked" in r]


def test_a_link_that_does_not_exist_is_asked_about() -> None:
    source = Path(__file__).parent / "models" / "ur10e.urdf"
    with pytest.raises(mg.InputError, match="did you mean 'wrist_1_link'"):
        mg.import_robot(source, tip="wrist1_link")
