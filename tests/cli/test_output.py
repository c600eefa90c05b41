"""What a terminal shows: tables as wide as it is, progress where there is none."""

import time
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import modelgen as mg
from modelgen.api.results import Table
from modelgen.calibration.lever import lever_of
from modelgen.cli import output
from modelgen.cli.app import app
from modelgen.fleet.run import Fleet

ROOT = Path(__file__).resolve().parents[2]
CAUSE = {
    "cause": "load_dependent_friction",
    "joint": "shoulder_lift_joint",
    "parameters": "coefficient 0.07433, rise 0.0124 s",
    "delta BIC": "289.3",
    "gain %": "24.1",
    "on test %": "47.1",
    "or perhaps": "",
    "the same as": "",
}


def shown(table: Table, capsys: pytest.CaptureFixture[str]) -> list[str]:
    output.print_table(table)
    return capsys.readouterr().out.splitlines()


@pytest.mark.parametrize("width", range(60, 161, 10))
def test_a_table_fits_and_breaks_no_word(
    width: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    table = Table("what the model lacks", dict.fromkeys(CAUSE, "left"), [list(CAUSE.values())], ("cause",))
    lines = shown(table, capsys)
    assert max(map(len, lines)) <= width
    words = {word for cell in CAUSE.values() for word in cell.split()}
    assert words <= {word for line in lines for word in line.split()}


def test_columns_without_a_word_are_left_out(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    rows = [list(CAUSE.values()), ["spring", "", "", "", "", "", "", "base_tilt"]]
    text = "\n".join(shown(Table("", dict.fromkeys(CAUSE, "left"), rows), capsys))
    assert "the same as" in text
    assert "or perhaps" not in text


def test_progress_is_a_line_now_and_then_where_there_is_no_terminal(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("MODELGEN_PROGRESS", "0.05")
    with output.progress_bar() as progress:
        progress("trying candidates", 3, 12)
        time.sleep(0.4)
    said = capsys.readouterr()
    assert said.out == ""
    lines = said.err.splitlines()
    assert 2 <= len(lines) <= 9
    assert all(line.endswith("s: trying candidates, 25 %") for line in lines)


def test_a_quick_command_says_nothing_of_its_progress(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("MODELGEN_PROGRESS")
    with output.progress_bar() as progress:
        progress("reading", 0, None)
    assert capsys.readouterr().err == ""


def test_the_help_names_every_exit_status() -> None:
    text = " ".join(CliRunner().invoke(app, ["--help"], env={"COLUMNS": "200"}).output.split())
    statuses = {
        "0": "done",
        "1": "a check failed",
        "2": "bad input",
        "130": "interrupted",
        "141": "the reader",
    }
    page = (ROOT / "docs" / "install.md").read_text(encoding="utf-8")
    for status, meaning in statuses.items():
        assert f"{status} {meaning}" in text
        assert f"| {status} | {meaning}" in page


def widest(text: str) -> int:
    """Length of the longest line of tables: of all that does not begin at the edge as sentences do."""
    return max(len(line) for line in text.splitlines() if line.startswith(" "))


def test_the_table_of_a_calibration_fits_sixty_columns(tmp_path: Path) -> None:
    arm, motor = mg.load_arms()["ariane4"], np.linspace(0.0, 20_000.0, 300)
    angle = lever_of(arm, 3).angle(motor) + 0.02
    table = np.column_stack([0.05 * np.arange(300), motor, angle])
    np.savetxt(tmp_path / "lever.csv", table, delimiter=",", header="t,qm3,q3", comments="")
    words = ["calibrate", str(tmp_path / "lever.csv"), "--arm", "ariane4", "--joint", "3"]
    done = CliRunner().invoke(app, [*words, "--out", str(tmp_path / "out")], env={"COLUMNS": "60"})
    assert done.exit_code == 0
    assert "qp_max" in done.output
    assert 30 < widest(done.output) <= 60


def test_the_table_of_a_fleet_fits_sixty_columns(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", "60")
    names = ["asymmetric_viscous_friction", "torque_constant_saturation"]
    joints = {"joints": [2, 4], "joint_names": ["shoulder_lift_joint", "forearm_roll_joint"]}
    row = {
        "unit": "a_unit_with_a_long_name",
        "verdict": "named",
        "causes": names,
        "cpu_seconds": 1.0,
    } | joints
    output.print_result(Fleet([row] * 12, 0, Path("fleet_of_the_season")), as_json=False)
    said = capsys.readouterr().out
    assert all(word in said for word in (*names, *joints["joint_names"]))
    assert 30 < widest(said) <= 60
