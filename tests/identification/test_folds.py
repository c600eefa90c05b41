"""What cross-validation holds out is what an identification of the rest is tried on."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from modelgen.cli.app import app

ARM = """\
schema: 1
convention: khalil_kleinfinger
arms:
  one:
    joints:
      - {name: j1, alpha: pi/2, effects: [viscous_friction]}
"""


@pytest.fixture
def log(tmp_path: Path) -> Path:
    """A pendulum of 0.4 kg m2 and 3 N m with friction, exact but for noise of the effort; 30 s at 100 Hz."""
    (tmp_path / "arms.yaml").write_text(ARM, encoding="utf-8")
    t = np.arange(3000) / 100
    q, dq, ddq = np.zeros((3, len(t)))
    for w, a in ((1.1, 0.8), (2.7, 0.3), (4.9, 0.1)):
        q += a * np.sin(w * t + w)
        dq += a * w * np.cos(w * t + w)
        ddq -= a * w**2 * np.sin(w * t + w)
    tau = 0.4 * ddq + 3.0 * np.cos(q) + 0.5 * dq + 0.1 * np.random.default_rng(0).normal(size=len(t))
    np.savetxt(
        tmp_path / "log.csv", np.column_stack([t, q, tau]), "%.12g", ",", header="t,q1,tau1", comments=""
    )
    return tmp_path / "log.csv"


def run(log: Path, *options: str) -> dict[str, object]:
    call = ["identify", str(log.parent / "arms.yaml"), "--arm", "one", "--cutoff", "5", "--json"]
    result = CliRunner().invoke(app, [*call, "--out", str(log.parent / "out"), *options])
    assert result.exit_code == 0, result.output
    found: dict[str, object] = json.loads(result.stdout)
    return found


def test_a_fold_is_the_identification_of_the_rest(log: Path) -> None:
    whole = run(log, "--train", str(log), "--folds", "3")
    folds = whole["folds"]
    assert isinstance(folds, dict)
    assert whole["test"] is None
    alone = run(log, "--train", f"{log}@0:10", "--train", f"{log}@20:30", "--test", f"{log}@10:20")["test"]
    assert isinstance(alone, dict)
    part = folds["parts"][1]
    assert part["test"] == "10 to 19.99 s"
    assert part["rmse"] == pytest.approx(alone["rmse"], rel=0.02)  # edges differ by a sample
    # the noise, 0.1 N m, through a low-pass of 5 Hz at 100 Hz
    assert folds["rmse"][0] == pytest.approx(0.1 * np.sqrt(5 / 50), rel=0.15)


def test_what_is_held_out_has_no_part_in_the_fit(log: Path) -> None:
    # friction three times as large in the second third: who has not seen it misses it, who has finds some
    table = np.loadtxt(log, delimiter=",", skiprows=1)
    middle = (table[:, 0] >= 10) & (table[:, 0] < 20)
    table[middle, 2] += 1.0 * np.gradient(table[:, 1], 0.01)[middle]
    np.savetxt(log, table, "%.12g", ",", header="t,q1,tau1", comments="")
    folds = run(log, "--train", str(log), "--folds", "3")["folds"]
    assert isinstance(folds, dict)
    speed = np.sqrt(np.mean(np.gradient(table[:, 1], 0.01)[middle] ** 2))
    assert folds["parts"][1]["rmse"][0] == pytest.approx(1.0 * speed, rel=0.05)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--folds", "1"], "--folds"),
        (["--folds", "40"], "a part is too short"),
        (["--folds", "3", "--compare-drives"], "expected --test LOG"),
        (["--folds", "3", "--stream"], "--folds"),
    ],
)
def test_folds_that_make_no_sense_are_refused(log: Path, options: list[str], message: str) -> None:
    call = ["identify", str(log.parent / "arms.yaml"), "--arm", "one", "--train", str(log), *options]
    result = CliRunner().invoke(app, [*call, "--out", str(log.parent / "out")])
    assert result.exit_code == 2
    assert message in result.output
    assert not (log.parent / "out").exists()
