"""What a terminal shows: tables as wide as it is, progress where there is none."""

import time

import pytest
from typer.testing import CliRunner

from modelgen.api.results import Table
from modelgen.cli import output
from modelgen.cli.app import app

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
    for status in ("0 done", "1 a check failed", "2 bad input", "130 interrupted", "141"):
        assert status in text
