"""Tables of standard Denavit-Hartenberg parameters: every frame where the textbook's product has it."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from typer.testing import CliRunner

import modelgen as mg
from modelgen.cli.app import app

PAGE = (Path(__file__).parents[2] / "docs" / "importing.md").read_text(encoding="utf-8")


def standard(a: float, alpha: float, d: float, theta: float) -> NDArray[np.float64]:
    """Siciliano, Sciavicco, Villani and Oriolo 2009, equation 2.52, as printed there."""
    ct, st, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    return np.array(
        [
            [ct, -st * ca, st * sa, a * ct],
            [st, ct * ca, -ct * sa, a * st],
            [0, sa, ca, d],
            [0, 0, 0, 1],
        ]
    )


def table(folder: Path, text: str) -> Path:
    path = folder / "table.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_the_page_s_table_is_the_shipped_arm(tmp_path: Path) -> None:
    """That one was described by hand, in the modified convention."""
    (text,) = re.findall(r"^```none\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)
    robot = mg.import_robot(table(tmp_path, text))
    ours, shipped = robot.arm.joints, mg.load_arms()["ur10e"].joints
    assert len(ours) == len(shipped) == 6
    for own, other in zip(ours, shipped, strict=True):
        for name in ("gamma", "b", "alpha", "d", "theta", "r"):
            assert getattr(own, name) == pytest.approx(getattr(other, name), abs=1e-15), (own.name, name)
        assert own.limits.position == pytest.approx(other.limits.position)
    assert not robot.arm.tools
    assert robot.links["frame6"][0] == "j6"


KINDS = ["rrpr", "prrfr", "rpprr"]


@pytest.mark.parametrize("kinds", KINDS)
def test_every_frame_is_where_the_product_has_it(kinds: str, tmp_path: Path) -> None:
    rng = np.random.default_rng(KINDS.index(kinds))
    rows = rng.uniform(-1.5, 1.5, (len(kinds), 4))
    lines = [f"{k},{','.join(map(repr, map(float, row)))}" for k, row in zip(kinds, rows, strict=True)]
    robot = mg.import_robot(table(tmp_path, "\n".join(["type,a,alpha,d,theta", *lines])), exact=True)
    arm = robot.arm
    q = rng.uniform(-2, 2, (5, len(arm.coordinates)))
    found = mg.build_model(arm).functions["forward_kinematics"](q)
    poses = dict(zip([joint.name for joint in arm.joints], found, strict=False))
    for s in range(len(q)):
        frame, moving = np.eye(4), iter(q[s])
        for k, (a, alpha, d, theta) in enumerate(rows):
            value = 0.0 if kinds[k] == "f" else next(moving)
            slide, turn = (value, 0.0) if kinds[k] == "p" else (0.0, value)
            frame = frame @ standard(a, alpha, d + slide, theta + turn)
            joint, offset = robot.links[f"frame{k + 1}"]
            assert joint is not None
            np.testing.assert_allclose(poses[joint][s] @ offset, frame, atol=1e-11)


def test_marks_units_and_separators(tmp_path: Path) -> None:
    """The arm of Stanford, whose third joint slides, and a fixed flange; as a German spreadsheet saves it."""
    text = (
        "# after Paul 1981\n"
        "name;θ;d (mm);a;α (deg);q_min;q_max\n"
        '"base turn";θ1;412;0;-90;;\n'
        "shoulder;q_2 - pi/2;154 mm;0;90°;-100 deg;100 deg\n"
        "slide;−90 deg;d3* + 50;0;0;100 mm;0.9\n"
        "flange;0,5;0.1 m;25,0 mm;180;;\n"
    )
    arm = mg.import_robot(table(tmp_path, text), exact=True).arm
    assert [(joint.name, joint.type) for joint in arm.joints] == [
        ("base_turn", "revolute"),
        ("shoulder", "revolute"),
        ("slide", "prismatic"),
    ]
    assert arm.joints[2].limits.position == (0.1, 0.9)
    assert arm.joints[1].limits.position == pytest.approx(np.radians([-100, 100]))
    q = np.array([[0.3, -0.4, 0.25]])
    *_, tool = mg.build_model(arm).functions["forward_kinematics"](q)
    right = np.pi / 2
    wanted = (
        standard(0, -right, 0.412, 0.3)
        @ standard(0, right, 0.154, -0.4 - right)
        @ standard(0, 0, 0.25 + 0.05, -right)
        @ standard(0.025, np.pi, 0.1, 0.5)
    )
    assert [t.name for t in arm.tools] == ["frame4"]
    np.testing.assert_allclose(tool[0], wanted, atol=1e-12)


HEAD = "a,alpha,d,theta\n"
BAD = {
    "no rows": (HEAD, r":1:1: the table has a header and no rows"),
    "empty": ("\n", "the table is empty, expected a header with a, alpha, d, theta"),
    "no header": ("0,1,2,3\n", r":1:1: found the column '0', expected a, alpha, d, theta"),
    "missing": ("a,alpha,theta\n0,0,0\n", r":1:1: found no column d"),
    "twice": ("a,alpha,d,theta,a\n0,0,0,0,0\n", r":1:17: the column a is there twice"),
    "short row": (HEAD + "0,0,0\n", r":2:1: found 3 cells, expected 4 as in the header"),
    "a word": (HEAD + "0,0,up,0\n", r":2:5: d: found 'up': the name 'up' is not known"),
    "no figure": (HEAD + "0,0, ,0\n", r":2:\d: d: the cell is empty, expected a number"),
    "degrees": (HEAD + "0,90,0,0\n", r":2:3: alpha: found 90, too large for rad: write \"deg\" or \"rad\""),
    "millimetres": (HEAD + "425,0,0,0\n", r":2:1: a: found 425, too large for m: write \"mm\" or \"m\""),
    "a length as angle": (HEAD + "0,5 mm,0,0\n", r":2:3: alpha: found '5 mm': 'mm' is a unit of length"),
    "two variables": (HEAD + "0,0,d1,q1\n", r":2:5: found a variable in d and in theta"),
    "reversed": (HEAD + "0,0,0,-q1\n", r":2:7: found '-q1': the joint's variable can only be added"),
    "modified": ("a_{i-1},alpha_{i-1},d,theta\n0,0,0,0\n", r":1:1: .* of the modified convention"),
    "no such type": (
        "type,a,alpha,d,theta\nball,0,0,0,0\n",
        r":2:1: found the type 'ball', expected revolute",
    ),
    "another type": (
        "type,a,alpha,d,theta\np,0,0,0,q1\n",
        r":2:1: found prismatic, but the row has its variable",
    ),
    "one limit": ("lower,upper,a,alpha,d,theta\n-1,,0,0,0,0\n", r":2:1: expected lower and upper"),
    "same name": ("name,a,alpha,d,theta\nx,0,0,0,0\nx,0,0,0,0\n", r":3:1: two joints are called 'x'"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_one_line_with_its_place(
    case: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    text, message = BAD[case]
    table(tmp_path, text)
    done = CliRunner().invoke(app, ["import", "table.csv"])
    assert done.exit_code == 2, done.output
    assert re.match(rf"table\.csv.*{message}|table\.csv{message}", done.stderr), done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert not Path("arms.yaml").exists()


def test_a_rounded_right_angle_is_one(tmp_path: Path) -> None:
    for heading in ("alpha", "alpha [rad]"):
        text = f"a,{heading},d,theta\n0.1,1.5708,0,q1\n0,0,0,q2\n"
        arm = mg.import_robot(table(tmp_path, text)).arm
        assert arm.joints[1].alpha == np.pi / 2
        (row,) = [r for r in mg.import_robot(table(tmp_path, text)).remarks if "multiples of 15 deg" in r]
        assert "1.5708" in row
