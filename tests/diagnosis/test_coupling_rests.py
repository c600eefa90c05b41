"""Where a part that turns with two joints rests, its dry friction is undetermined, and no equation holds."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hidden.cases import Case, Hidden, make
from hidden.running import diagnosed_here

from modelgen.dataset import prepare, read
from modelgen.description import load
from modelgen.diagnosis.equations.rows import of_arm, turning

# Heavy friction of a part that turns with both joints: what its rests leave looks like a delay.
COUPLED = Case("levered2", 1153009354, (Hidden("transmission_coupling", 1, 1.3, 0.20286240860220528),))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("coupled") / "case"
    make(COUPLED, made)
    return made


def test_rows_count_where_the_coupling_turns(folder: Path) -> None:
    arm = load(folder / "arms.yaml")["arm"]
    prepared = prepare(read(str(folder / "train_a.csv"), arm))
    found = turning(prepared, 2, other=1, ratio=-1.0)
    slow = np.abs(prepared.dq[:, 1] - prepared.dq[:, 0]) < sum(prepared.settings.rest_speeds)
    assert (found[:, 0] == found[:, 1]).all()
    assert not slow[prepared.rows[found[:, 0]]].any()
    rests = prepared.time[slow]  # as far as the filter of the equations reaches, it mixes in what rests
    away = np.abs(prepared.time[prepared.rows[~found[:, 0]]][:, None] - rests).min(axis=1)
    assert away.max() < prepared.settings.trim
    assert 0.8 < found.mean() < 0.99
    assert of_arm(arm, prepared).all()  # the description knows of none


def test_the_rests_of_a_coupling_are_no_delay(folder: Path) -> None:
    answer = diagnosed_here(folder, "arm")
    assert [(c["effect"], c["joint"]) for c in answer["causes"]] == [("transmission_coupling", 2)]
    found = {name: value["value"] for name, value in answer["causes"][0]["parameters"].items()}
    assert found["viscous"] == pytest.approx(0.211, rel=0.1)
    assert found["dry"] == pytest.approx(0.773, rel=0.03)
