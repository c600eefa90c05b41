"""Measured logs through the command. Skipped where the logs are absent."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from modelgen.cli.app import app

ROOT = Path(__file__).resolve().parents[2]
STUDIES = ROOT / "examples" / "case_studies"
DATA = ROOT.parent / "shared" / "data"

pytestmark = pytest.mark.skipif(not DATA.is_dir(), reason="needs the measured logs beside the repository")


def test_emps_meets_the_published_values_and_reaches_the_generated_code(tmp_path: Path) -> None:
    # Janot, Gautier and Brunot (2019); 20 Hz, structure M, Fv, Fc, offset.
    arm, out = STUDIES / "emps_arm.yaml", tmp_path / "out"
    train, test = (f"{DATA}/emps/emps_{part}.csv" for part in ("train", "pulses"))
    mapping = f"{STUDIES}/emps_mapping.yaml"
    call = ["identify", str(arm), "--arm", "emps", "--train", train, "--test", test, "--mapping", mapping]
    result = CliRunner().invoke(app, [*call, "--cutoff", "20", "--out", str(out), "--json"])
    assert result.exit_code == 0, result.output
    data = json.loads((out / "identification.json").read_text())
    assert json.loads(result.stdout) == data
    value = {p["name"]: p["value"] for p in data["parameters"]}
    assert [value["M1"], value["FV1"], value["FC1"]] == pytest.approx([95.1, 203.5, 20.4], rel=0.02)
    assert value["FO1"] == pytest.approx(-3.2, abs=0.2)
    assert data["test"]["rmse"][0] <= 3.9
    folder = tmp_path / "generated"
    call = ["generate", str(arm), "--arm", "emps", "--parameters", str(out / "emps_parameters.yaml")]
    result = CliRunner().invoke(app, [*call, "--out", str(folder), "-j", "1"])
    assert result.exit_code == 0, result.output
    assert "emps_inverse_dynamics_identified" in (folder / "emps/include/emps.h").read_text()


def test_tx40_with_its_coupled_wrist_predicts_each_third_of_its_motion_from_the_others(
    tmp_path: Path,
) -> None:
    call = ["identify", str(STUDIES / "tx40_arm.yaml"), "--arm", "tx40"]
    call += ["--mapping", str(STUDIES / "tx40_mapping.yaml"), "--train", f"{DATA}/tx40/tx40_motor.csv@0:7.4"]
    call += ["--cutoff", "10", "--folds", "3", "--out", str(tmp_path), "--json"]
    result = CliRunner().invoke(app, call)
    assert result.exit_code == 0, result.output
    data = json.loads(result.stdout)["folds"]
    limits = (6.7, 6.5, 10.0, 8.9, 31.0, 20.0)
    assert all(x <= limit for x, limit in zip(data["nrmse_percent"], limits, strict=True))
    parts = np.array([part["nrmse_percent"] for part in data["parts"]])
    assert len(parts) == 3
    # together lies between the parts
    assert (parts.min(axis=0) < data["nrmse_percent"]).all()
    assert (data["nrmse_percent"] < parts.max(axis=0)).all()


def test_tx40_predicts_what_was_held_out(tmp_path: Path) -> None:
    # 0 to 5 s fitted, 5 to 7.4 s held out, 10 Hz. The wrist is coupled: joints 5 and 6 share motor 6.
    log, mapping = f"{DATA}/tx40/tx40_motor.csv", f"{STUDIES}/tx40_mapping.yaml"
    call = [
        "identify",
        str(STUDIES / "tx40_arm.yaml"),
        "--arm",
        "tx40",
        "--mapping",
        mapping,
        "--cutoff",
        "10",
    ]
    call += ["--train", f"{log}@0:5", "--test", f"{log}@5:7.4", "--method", "gls", "--essential", "--json"]
    result = CliRunner().invoke(app, [*call, "--out", str(tmp_path / "out")])
    assert result.exit_code == 0, result.output
    share = json.loads(result.stdout)["test"]["nrmse_percent"]
    assert all(x <= limit for x, limit in zip(share, [6.7, 6.5, 10.0, 8.9, 31.0, 20.0], strict=True))
