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


def found(folder: Path, weights: float | None, effects: tuple[str, ...]) -> mg.Diagnosis:
    logs = [str(folder / f"{name}.csv") for name in ("train_a", "train_b", "test")]
    return mg.diagnose(described(folder, weights), logs[:2], logs[2], effects=list(effects), experiment=False)


@pytest.mark.parametrize(("weights", "most"), [(1.0, 0.04), (0.7, 0.04), (1.4, 0.04), (None, 0.15)])
def test_a_tilt_is_as_large_as_it_is_whatever_nominal_links_weigh(
    weights: float, most: float, folder: Path
) -> None:
    """And nothing is left that would be a spring: weights that are described wrongly, or not at all, swing
    with the first joint as one does. most: deviation over the tilt.
    """
    result = found(folder, weights, ("base_tilt", "spring", "friction_offset"))
    (cause,) = result.causes
    x, y = cause.parameters["x"], cause.parameters["y"]
    size = np.hypot(x.value, y.value)
    assert x.std is not None
    assert y.std is not None
    std = np.hypot(x.value * x.std, y.value * y.std) / size
    assert abs(size - TILT) < 2.5 * std
    assert std < most * TILT
    assert "deterministic remains" not in result.reason
