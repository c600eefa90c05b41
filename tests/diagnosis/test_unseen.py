"""The test record has no part in a diagnosis but in its errors."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hidden.cases import Case, Hidden, make

from modelgen.dataset import Record
from modelgen.description import load
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.diagnosis.pipeline import diagnose, records
from modelgen.diagnosis.result import Diagnosis, to_json


def shaken(record: Record) -> Record:
    """Another motion, with noise of the positions that no encoder has, and other efforts."""
    noise = np.random.default_rng(3).normal(scale=2e-3, size=record.q.shape)
    efforts = None if record.input is None else 1.1 * record.input
    return replace(record, q=0.7 * record.q + noise, input=efforts)


def said(d: Diagnosis) -> dict[str, Any]:
    """All but what is measured on the test record."""
    whole = to_json(d)
    for name in ("error", "simulation"):
        del whole[name]
    del whole["settings"]["test"]
    for cause in whole["causes"]:  # which the test record confirms or not
        cause["checks"] = [check for check in cause["checks"] if check["name"] != "confirmed"]
    return whole


@pytest.mark.parametrize(
    "case",
    [
        Case("pendulum2", 4, (Hidden("spring", 1, 1.3),)),
        Case("direct2", 5, (Hidden("stribeck_friction", 1, 1.3),)),
    ],
    ids=lambda case: case.arm,
)
def test_another_test_record_leaves_all_but_the_errors(case: Case, tmp_path: Path) -> None:
    make(case, tmp_path)
    arm = load(tmp_path / "arms.yaml")["arm"]
    names = [str(tmp_path / f"{name}.csv") for name in ("train_a", "train_b", "test")]
    *train, test = records(arm, names[:2], names[2:], None, USUAL.dataset)
    one = diagnose(arm, [*train, test], experiment=False)
    other = diagnose(arm, [*train, shaken(test)], experiment=False)
    assert one.causes
    assert said(one) == said(other)
    assert one.errors.before[0] != other.errors.before[0]
