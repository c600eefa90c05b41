"""modelgen inspect: facts of a log, and a mapping that the log can be read by."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from dataset_support import DRIVEN, columns, motion, times, write_csv
from typer.testing import CliRunner

from modelgen.cli.app import app
from modelgen.dataset import read


def called(*words: str) -> str:
    result = CliRunner().invoke(app, ["inspect", *words])
    assert result.exit_code == 0, result.output
    return result.stdout


def test_a_log_is_inspected(tmp_path: Path) -> None:
    t = times()
    shown = called(write_csv(tmp_path / "a.csv", columns(t)))
    assert "1600 samples from 0 s to 7.995 s at 200 Hz" in shown
    data = json.loads(called(str(tmp_path / "a.csv"), "--json"))
    assert data["rate_hz"] == pytest.approx(200.0)
    assert [c["name"] for c in data["channels"]] == ["q1", "qm2", "i1", "i2"]


def test_the_skeleton_reads_the_log(tmp_path: Path) -> None:
    t = times()
    q, dq, _ = motion(t)
    table = {"stamp_ms": 1e3 * t, "hip_pos": q[:, 0], "knee_pos": q[:, 1]}
    table |= {"hip_current": dq[:, 0], "knee_current": dq[:, 1]}
    file = write_csv(tmp_path / "a.csv", table)
    mapping = tmp_path / "m.yaml"
    called(file, "--skeleton", str(mapping))
    assert "# ?" in mapping.read_text(encoding="utf-8")
    record = read(file, DRIVEN, mapping)
    assert record.q == pytest.approx(q)
    assert record.step == pytest.approx(1 / 200)
    assert np.array_equal(record.input, np.asarray(dq))


def test_what_is_no_log_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("nothing\n")
    result = CliRunner().invoke(app, ["inspect", str(tmp_path / "b.csv")])
    assert result.exit_code == 2
    assert "there is no such log" in result.stderr


def test_a_mapping_needs_no_arm(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    t = times()
    q, dq, _ = motion(t)
    file = write_csv(tmp_path / "a.csv", {"t": t, "hip_pos": q[:, 0], "hip_current": dq[:, 0]})
    called(file, "--skeleton", "m.yaml")
    shown = called(file, "--mapping", "m.yaml")
    assert "1600 samples from 0 s to 7.995 s at 200 Hz" in shown
    assert "q1" in shown
    assert "rad " in shown


def test_the_picture_is_written(tmp_path: Path) -> None:
    called(write_csv(tmp_path / "a.csv", columns(times())), "--plot", str(tmp_path / "a.svg"))
    assert (tmp_path / "a.svg").read_text(encoding="utf-8").startswith("<?xml")


def test_a_picture_is_no_other_kind_of_file(tmp_path: Path) -> None:
    file = write_csv(tmp_path / "a.csv", columns(times()))
    result = CliRunner().invoke(app, ["inspect", file, "--plot", str(tmp_path / "a.png")])
    assert result.exit_code == 2
    assert "the picture is an SVG, expected" in " ".join(result.stderr.split())
    assert not (tmp_path / "a.png").exists()


def test_a_word_in_a_column_of_numbers_is_said(tmp_path: Path) -> None:
    file = Path(write_csv(tmp_path / "a.csv", columns(times())))
    lines = file.read_text(encoding="utf-8").splitlines()
    cells = lines[500].split(",")
    lines[500] = ",".join([cells[0], "abc", *cells[2:]])
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    data = json.loads(called(str(file), "--json"))
    assert data["without_numbers"] == ["q1"]
    assert any("the column q1 is left out: found 'abc'" in remark for remark in data["remarks"])
