"""What a terminal shows: tables as wide as it is, progress where there is none."""

import re
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from diagnosis_support import ARM, three
from typer.testing import CliRunner

import modelgen as mg
from modelgen.api.identification import Identification
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
    "unseen %": "24.1",
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
    assert not lines[-1]  # what is printed next stands apart


def test_a_title_is_as_wide_as_the_terminal_and_no_quantity_is_torn(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """However narrow its table is; what is copied has plain spaces."""
    monkeypatch.setenv("COLUMNS", "60")
    narrow = {"joint": "right", "error": "right"}
    lines = shown(Table("error on the test record [A]", narrow, [["elbow", "0.0013"]]), capsys)
    assert lines[0] == "error on the test record [A]"
    values = "every 2.5 mm, sine 0.002524 N m, cosine -0.01234 N m s/rad, at 0.25 kg m^2"
    for width in range(60, 100):
        monkeypatch.setenv("COLUMNS", str(width))
        text = shown(Table("", {"cause": "left", "values": "left"}, [["x" * 36, values]]), capsys)
        for quantity in ("2.5 mm,", "0.002524 N m,", "-0.01234 N m s/rad,", "0.25 kg m^2"):
            assert any(quantity in line for line in text), (width, text)
        output.say(
            "The data agree, of efforts that were read: 0.50 ± 0.065 samples after it, 12 ± 0.4 mm off."
        )
        said = capsys.readouterr().out.splitlines()
        for quantity in ("0.50 ± 0.065 samples", "12 ± 0.4 mm"):
            assert any(quantity in line for line in said), (width, said)
    output.say(values * 20)
    assert "\ue000" not in capsys.readouterr().out


def test_units_in_brackets_are_in_the_help() -> None:
    for command, said in (("inspect", "FILE@t0:t1 [s]."), ("simulate", "link [kg], in its frame [m].")):
        text = CliRunner().invoke(app, [command, "--help"], env={"COLUMNS": "200"}).stdout
        assert said in text
    text = CliRunner().invoke(app, ["diagnose", "--help"], env={"COLUMNS": "200"}).stdout
    assert "FILE or FILE@t0:t1 [s]; repeatable." in text
    assert "The record for the final errors alone; needed." in text
    assert "\\" not in text


@pytest.mark.parametrize("width", [60, 75, *range(84, 121, 3)])
def test_the_catalogue_loses_no_word_at_any_width(width: int) -> None:
    def said(columns: int) -> tuple[set[str], int]:
        text = CliRunner().invoke(app, ["effects"], env={"COLUMNS": str(columns)}).stdout
        return set(re.findall(r"[\w.]+", text)), max(map(len, text.splitlines()))

    words, wide = said(width)
    assert wide <= width
    assert said(1000)[0] <= words


SENTENCE = "the extended model against the test record, " + 8 * "which is a long sentence, " + "ends"
COMMAND = "modelgen simulate found/digger_extended.yaml --parameters found/digger_parameters.yaml --log b.csv"


@pytest.mark.parametrize("width", range(60, 161, 20))
def test_sentences_are_wrapped_and_commands_are_not(
    width: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    output.say(SENTENCE, COMMAND)
    *text, command = capsys.readouterr().out.splitlines()
    assert command.strip() == COMMAND
    assert max(map(len, text)) <= width
    assert len(text) == pytest.approx(len(SENTENCE) / width, abs=1.5)
    assert " ".join(" ".join(text).split()) == SENTENCE.strip()
    output.say(" ".join(f"{k} %, {k} N m," for k in range(100)))
    assert not any(line.split()[0] in ("%,", "N") for line in capsys.readouterr().out.splitlines())


def test_nothing_is_wrapped_for_a_program(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """That reads stdout, or a message on stderr: one line each."""
    monkeypatch.delenv("COLUMNS", raising=False)
    output.say(SENTENCE, COMMAND)
    assert capsys.readouterr().out == f"{SENTENCE} {COMMAND}\n"
    words = ["identify", "--train", f"{60 * 'a'}.csv", "--out", "x", "--arm", "ariane4"]
    done = CliRunner().invoke(app, words, env={"COLUMNS": "60"})
    assert done.exit_code == 2
    assert len(done.stderr.splitlines()) == 1
    assert len(done.stderr) > 80


EXAMPLE = ROOT / "examples" / "diagnosis"
LOGS = [
    *("--train", str(EXAMPLE / "train_a.csv"), "--train", str(EXAMPLE / "train_b.csv")),
    *("--test", str(EXAMPLE / "test.csv")),
]
COMMANDS = {
    "identify": [str(EXAMPLE / "arms.yaml"), *LOGS, "--verbose"],
    "diagnose": [str(EXAMPLE / "arms.yaml"), *LOGS, "--effect", "load_dependent_friction", "-j", "1"],
    "excite": ["--arm", "ariane4", "--period", "5", "--starts", "1", "--iterations", "3", "-j", "1"],
    "show": [str(EXAMPLE / "arms.yaml")],
    "inspect": [str(EXAMPLE / "test.csv")],
    "effects": [],
}


@pytest.mark.parametrize("name", COMMANDS)
def test_what_a_command_prints_fits_sixty_columns(name: str, tmp_path: Path) -> None:
    """But for commands and paths, which are copied in one piece."""
    out = {"excite": ["--out", str(tmp_path / "a.csv")], "identify": ["--out", str(tmp_path)]}
    out["diagnose"] = out["identify"]
    words = [name, *COMMANDS[name], *out.get(name, [])]
    done = CliRunner().invoke(app, words, env={"COLUMNS": "60"})
    assert done.exit_code == 0, done.output
    long = [line for line in done.stdout.splitlines() if len(line) > 60]
    assert [x for x in long if not x.startswith("  modelgen ") and "/" not in max(x.split(), key=len)] == []


def test_remarks_that_are_left_out_are_shown_on_demand() -> None:
    """Of ten, as many as six lines have room for, then how many more there are; the report has all."""
    train, _, test = three(None, 1, 0.0)
    found = mg.identify(ARM, train=train, test=test)
    log = found.outcome.log
    first = replace(log.train[0], remarks=tuple(f"remark {k}" for k in range(10)))
    result = Identification(
        replace(found.outcome, log=replace(log, train=(first, *log.train[1:]))), found.call
    )
    lines = [part for part in result.shown() if isinstance(part, str) and part.startswith("log: ")]
    assert len(lines) == 6
    shown = [line for line in lines if "remark " in line]
    assert f"{10 - len(shown)} more remarks: --verbose" in lines[-1]
    assert [*shown, *result.details()] == [f"log: remark {k}" for k in range(10)]
    assert all(f"remark {k}" in result.files()["report.html"] for k in range(10))


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
    assert all(line.endswith("s: trying candidates, 3 of 12") for line in lines)
    with output.progress_bar(counted=False) as progress:
        progress("reading", 0.5, 2.0)
        time.sleep(0.2)
    assert all(line.endswith("s: reading, 25 %") for line in capsys.readouterr().err.splitlines())


@pytest.mark.parametrize("processes", [1, 2])
def test_an_excitation_says_how_far_its_starts_are(processes: int, tmp_path: Path) -> None:
    """Every so many seconds, by the iterations of all of them, wherever they run."""
    starts = ["--starts", str(processes), "-j", str(processes)]
    words = ["excite", "--arm", "ariane4", "--period", "20", "--iterations", "60", *starts]
    done = CliRunner().invoke(
        app, [*words, "--out", str(tmp_path / "a.csv")], env={"MODELGEN_PROGRESS": "0.5"}
    )
    assert done.exit_code == 0
    said = rf"s: ariane4: iterations of {processes} starts, 0 done, (\d+) of {60 * processes}$"
    found = re.findall(said, done.stderr, re.MULTILINE)
    within = [int(n) for n in found if 0 < int(n) < 60 * processes]
    assert len(within) >= 2
    assert within == sorted(within)


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
    """Length of the longest line of tables: of all that does not begin at the edge as sentences do, and is
    no path, which goes on in one piece.
    """
    return max(len(line) for line in text.splitlines() if line.startswith(" ") and "/" not in line)


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
