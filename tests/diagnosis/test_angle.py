"""Where the base of an actuator stands is found all the way round."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hidden.cases import Case, make

from modelgen.dataset import choose, prepare
from modelgen.description import load
from modelgen.diagnosis.candidates.candidate import Candidate, candidates
from modelgen.diagnosis.candidates.columns import candidate_columns
from modelgen.diagnosis.candidates.search import Search, bracket
from modelgen.diagnosis.equations import Equations, estimated, settings_for, settled_rows
from modelgen.diagnosis.evidence.system import System
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.diagnosis.pipeline import records
from modelgen.evaluation import Evaluator
from modelgen.functions import build_model
from modelgen.numeric import Array
from modelgen.regression.weighted import weighted_fit

pytestmark = pytest.mark.xdist_group("angle")


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> tuple[Equations, Array, Candidate]:
    """Rows of an arm without an actuator's mass, what else they show, and the mass as a candidate."""
    folder = tmp_path_factory.mktemp("angle") / "case"
    make(Case("levered2", 5), folder)
    arm = load(folder / "arms.yaml")["arm"]
    found = records(arm, [str(folder / "train_a.csv")], [str(folder / "test.csv")], None, USUAL.dataset)
    model, evaluator = build_model(arm), Evaluator(arm)
    prepared = [prepare(r, choose(list(found), settings_for(found, None, USUAL))) for r in found]
    rows = settled_rows(evaluator, model, prepared, estimated(model, USUAL.equations))
    equations = Equations(model, evaluator, rows, [None] * len(rows), USUAL)
    base = equations.base(weighted_fit(rows, equations.columns))
    pool = candidates(equations)
    forms = [c for c in pool if c.effect == "actuator_mass" and c.joint == 2]
    assert all([p.name for p in c.searched] == ["base_angle"] for c in forms)  # joint 1 moves its base
    return equations, base, max(forms, key=lambda c: len(c.part))


@pytest.mark.parametrize("degrees", [5, 40, 44, 58, 130, 222, 357])
def test_the_base_is_found_where_it_stands(scene: tuple[Equations, Array, Candidate], degrees: float) -> None:
    equations, base, candidate = scene
    there = {"base_angle": math.radians(degrees)}
    added = candidate_columns(replace(candidate, part=()), there, equations, base)
    assert added is not None
    moved = [
        replace(r, effort=r.effort + c @ np.array([0.2, 1.0, 0.0]))
        for r, c in zip(equations.rows, added, strict=True)
    ]
    search = Search(System(equations.with_rows(moved)))
    found = search.trial(candidate)
    assert found is not None
    off = math.remainder(found.parameters["base_angle"] - there["base_angle"], math.tau)
    assert abs(math.degrees(off)) < 3.0
    assert abs(found.parameters["base_angle"]) <= math.pi


def test_neighbours_of_an_angle_go_round() -> None:
    angles = [1.0, 2.0, 3.0]
    assert bracket(angles, 0, turns=False) == (1.0, 2.0)
    assert bracket(angles, 1, turns=True) == (1.0, 3.0)
    assert bracket(angles, 0, turns=True) == (3.0, 2.0 + math.tau)
    assert bracket(angles, 2, turns=True) == (2.0, 1.0 + math.tau)
