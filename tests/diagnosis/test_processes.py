"""The answer does not depend on how many processors had a part in it."""

from pathlib import Path

from typer.testing import CliRunner

from modelgen.cli.app import app

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "diagnosis"


def test_answer_and_report_are_the_same_to_the_byte(tmp_path: Path) -> None:
    logs = ["--train", "train_a.csv", "--train", "train_b.csv", "--test", "test.csv"]
    given = ["diagnose", str(EXAMPLE / "arms.yaml"), "--arm", "digger"]
    given += [str(EXAMPLE / text) if text.endswith(".csv") else text for text in logs]
    for jobs in ("1", "3"):
        out = str(tmp_path / jobs)
        done = CliRunner().invoke(app, [*given, "--no-experiment", "--jobs", jobs, "--out", out])
        assert done.exit_code == 0, done.output
    alone, together = ({f.name: f.read_bytes() for f in (tmp_path / j).glob("*.*")} for j in ("1", "3"))
    assert {"diagnosis.json", "report.html"} <= alone.keys()
    assert alone == together
