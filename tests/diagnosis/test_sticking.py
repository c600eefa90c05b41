"""Joints that stick: dry friction is undetermined while they rest, and says nothing about the arm."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hidden.cases import Case, Hidden, make
from hidden.running import diagnosed_here, run_here

from modelgen.dataset import Settings, prepare, read
from modelgen.description import load
from modelgen.diagnosis.equations import estimated, rows_of
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.evaluation import Evaluator
from modelgen.functions import build_model


@pytest.mark.parametrize(("arm", "seed"), [("levered2", 3169508213), ("levered3", 3421367267)])
def test_nothing_is_missing_where_joints_stick_at_every_reversal(arm: str, seed: int, tmp_path: Path) -> None:
    case = Case(arm, seed, dry=5.0)
    make(case, tmp_path / "case")
    answer = diagnosed_here(tmp_path / "case", case.name)
    assert answer["verdict"] == "nothing_missing", answer["reason"]


def test_nothing_is_missing_where_a_joint_sticks_for_a_moment_in_some_periods(tmp_path: Path) -> None:
    case = Case("mixed2", 2732881948)
    make(case, tmp_path / "case")
    answer = diagnosed_here(tmp_path / "case", case.name)
    assert answer["verdict"] == "nothing_missing", answer["reason"]
    late = [c for c in answer["ranking"][0] if c["effect"] == "time_delay"]
    assert max(c["delta_bic"] for c in late) < 6.0  # the reversals look late by a sample where they stick


@pytest.mark.parametrize(
    "case",
    [
        Case("levered2", 3169508213, (Hidden("friction_offset", 1, 1.1, 8.679372394998),)),
        Case("mixed2", 2850154501, (Hidden("time_delay", 2, 1.05, 1.954201570986),)),
    ],
)
def test_a_cause_is_found_at_a_joint_that_sticks(case: Case, tmp_path: Path) -> None:
    outcome, _ = run_here(case, tmp_path / "case")
    assert outcome.result == "found", outcome


def test_what_the_effort_is_while_a_joint_rests_changes_no_equation(tmp_path: Path) -> None:
    case = Case("levered2", 3169508213, dry=5.0)
    make(case, tmp_path / "case")
    arm = load(tmp_path / "case" / "arms.yaml")[case.name]
    record = read(str(tmp_path / "case" / "train_a.csv"), arm)
    assert record.input is not None
    resting = np.abs(np.gradient(record.motor, record.step, axis=0)) < 1e-9
    assert resting.mean(axis=0).max() > 0.02
    tried = [record, replace(record, input=np.where(resting, 1e3, record.input))]
    model, evaluator = build_model(arm), Evaluator(arm)
    before, after = (
        rows_of(evaluator, model, prepare(r, Settings(cutoff=18.0)), None, estimated(model, USUAL.equations))
        for r in tried
    )
    np.testing.assert_array_equal(after.moving, before.moving)
    np.testing.assert_allclose(after.effort[after.moving], before.effort[after.moving], atol=1e-9)
