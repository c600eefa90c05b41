"""The answer does not depend on how many processors had a part in it."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from modelgen.cli.app import app

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "diagnosis"


def test_answer_and_report_are_the_same_to_the_byte(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    logs = ["--train", "train_a.csv", "--train", "train_b.csv", "--test", "test.csv"]
    given = ["diagnose", str(EXAMPLE / "arms.yaml"), "--arm", "digger"]
    given += [str(EXAMPLE / text) if text.endswith(".csv") else text for text in logs]
    for jobs in ("1", "3"):
        (tmp_path / jobs).mkdir()
        monkeypatch.chdir(tmp_path / jobs)  # a report has the commands that go on from its folder
        done = CliRunner().invoke(app, [*given, "--no-experiment", "--jobs", jobs, "--out", "found"])
        assert done.exit_code == 0, done.output
    alone, together = (
        {f.name: f.read_bytes() for f in (tmp_path / j / "found").glob("*.*")} for j in ("1", "3")
    )
    assert {"diagnosis.json", "report.html"} <= alone.keys()
    assert alone == together
