"""Friction by all that a transmission carries, or by the links' weight alone: which it is, is found."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hidden.cases import Case, Hidden, make
from typer.testing import CliRunner

from modelgen.cli.app import app


@pytest.mark.parametrize(("carried", "magnitude"), [(True, 0.3398), (False, 0.5)])
def test_what_the_friction_follows_is_found(*, carried: bool, magnitude: float, tmp_path: Path) -> None:
    hidden = Hidden("load_dependent_friction", 2, 1.3, magnitude, carried=carried)
    label = make(Case("direct2", 22, (hidden,), train=2), tmp_path)
    call = ["diagnose", str(tmp_path / "arms.yaml"), "--arm", "arm", "--no-experiment"]
    for name in ("train_a", "train_b"):
        call += ["--train", str(tmp_path / f"{name}.csv")]
    done = CliRunner().invoke(
        app, [*call, "--test", str(tmp_path / "test.csv"), "--out", str(tmp_path / "d")]
    )
    assert done.exit_code == 0, done.output
    found = json.loads((tmp_path / "d" / "diagnosis.json").read_text(encoding="utf-8"))
    (cause,) = found["causes"]
    assert (cause["effect"], cause["joint"]) == ("load_dependent_friction", 2)
    assert ("rise" in cause["parameters"]) is carried
    assert cause["parameters"]["coefficient"]["value"] == pytest.approx(0.1 * magnitude, rel=0.1)
    before, after = found["error"]["before"][1], found["error"]["after"][1]
    assert after - label.floor[1] < 0.1 * (before - label.floor[1])
    # the extended model simulates the motion better, not only the inputs
    motion = (found["simulation"][side]["rmse"][1] for side in ("after", "before"))
    assert next(motion) < next(motion)
