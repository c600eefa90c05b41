"""A part that turns with two joints by a gear: its ratio is found, with its deviation."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hidden import effects
from hidden.cases import Case, Hidden, make
from hidden.native import Plant
from hidden.running import diagnosed_here

from modelgen.diagnosis.evidence.likelihood import independent_of

RATIO = -0.4  # turns of the joint before per turn of the part


@pytest.fixture(scope="module")
def answer(tmp_path_factory: pytest.TempPathFactory) -> dict:
    usual = effects.EFFECTS["transmission_coupling"]

    def geared(plant: Plant, site: effects.Site, magnitude: float) -> None:
        usual.put(plant, site, magnitude)
        plant["coupling_ratio"][site.joint] = RATIO

    made = tmp_path_factory.mktemp("geared") / "case"
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(effects.EFFECTS, "transmission_coupling", replace(usual, put=geared))
        make(Case("levered2", 20261128, (Hidden("transmission_coupling", 2, 1.3),)), made)
    return diagnosed_here(made, "arm")


def test_the_ratio_of_a_coupling_is_found(answer: dict) -> None:
    assert [(c["effect"], c["joint"]) for c in answer["causes"]] == [("transmission_coupling", 2)]
    found = answer["causes"][0]["parameters"]["ratio"]
    assert 0.0 < found["std"] < 0.1 * abs(RATIO)
    assert abs(found["value"] - RATIO) < 3.0 * found["std"]


def test_of_columns_that_depend_on_each_other_the_clearest_is_kept() -> None:
    random = np.random.default_rng(0)
    basis = np.linalg.qr(random.normal(size=(50, 3)))[0]
    own = random.normal(size=(50, 2))
    inside, both = basis @ random.normal(size=3), own[:, 0] + own[:, 1]
    columns = np.column_stack([own[:, 0], inside, own[:, 1], both])
    found = independent_of(columns / np.linalg.norm(columns, axis=0), basis)
    assert not found[1]
    assert found[[0, 2, 3]].sum() == 2
    assert math.isclose(np.linalg.matrix_rank(columns[:, found]), 2)
