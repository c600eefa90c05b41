"""How far a tilt can be off: weights that no record of an upright arm shows are nominal ones."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml
from hidden.cases import Case, Hidden, make

import modelgen as mg
from modelgen.description import Arm, loads
from modelgen.effects import known_effects

TILT = 0.05  # rad, of the plant's base about a horizontal axis


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Records of an arm whose base leans."""
    place = tmp_path_factory.mktemp("leaning")
    make(Case("direct3", 7, (Hidden("base_tilt", 2, 1.3, 1.0),), "motor", 250.0, 3, train=2), place)
    return place


def described(folder: Path, weights: float | None) -> Arm:
    """The arm, its nominal links so many times as heavy as they are, or without any."""
    made = yaml.safe_load((folder / "arms.yaml").read_text())
    arm = made["arms"]["arm"]
    for link in arm["links"].values() if weights is not None else ():
        link["mass"] *= weights
        link["inertia"] = [weights * x for x in link["inertia"]]
    if weights is None:
        del arm["links"]
    return loads(yaml.safe_dump(made), "arms.yaml", known_effects())["arm"]


def found(folder: Path, weights: float | None) -> mg.Diagnosis:
    logs = [str(folder / f"{name}.csv") for name in ("train_a", "train_b", "test")]
    return mg.diagnose(described(folder, weights), logs[:2], logs[2], effects=["base_tilt"], experiment=False)


@pytest.mark.parametrize("weights", [1.0, 0.7, 1.4])
def test_deviations_of_a_tilt_hold_what_nominal_links_are_off_by(weights: float, folder: Path) -> None:
    (cause,) = found(folder, weights).causes
    x, y = cause.parameters["x"], cause.parameters["y"]
    size = np.hypot(x.value, y.value)
    assert x.std is not None
    assert y.std is not None
    std = np.hypot(x.value * x.std, y.value * y.std) / size
    assert abs(size - TILT) < 2.5 * std
    assert std < 0.5 * TILT


def test_without_nominal_links_a_tilt_has_no_deviation_and_says_why(folder: Path) -> None:
    result = found(folder, None).to_json()
    (cause,) = result["causes"]
    assert [p["std"] for p in cause["parameters"].values()] == [None, None]
    (said,) = (x["reason"] for x in result["not_identifiable"] if x["effect"] == "base_tilt")
    assert "weights that an upright arm hides" in said
