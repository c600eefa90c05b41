"""What a fluid does to an arm whose end nobody has described gets its name, and a size that is a guess."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hidden.cases import Case, Hidden, make
from hidden.running import diagnosed_here

SAYS = "nominal inertials, or tip_x, tip_y and tip_z, say where j2 ends"


def answer(case: Case, folder: Path) -> dict:
    """To logs of an arm whose description ends at its last joint."""
    make(case, folder)
    description = folder / "arms.yaml"
    without = re.sub(r"\n    links:\n.*", "\n", description.read_text(encoding="utf-8"), flags=re.DOTALL)
    assert "mass" not in without
    description.write_text(without, encoding="utf-8")
    return diagnosed_here(folder, case.name)


def test_a_fluid_is_named_without_its_size(tmp_path: Path) -> None:
    found = answer(Case("levered2", 113, (Hidden("fluid_drag", 2, 1.3, 0.384645),)), tmp_path / "case")
    (cause,) = found["causes"]
    assert (cause["effect"], cause["joint"]) == ("fluid_drag", None)
    values = cause["parameters"]
    assert values["coefficient"]["value"] > 0.0
    assert values["coefficient"]["std"] is None
    assert abs(values["tip_x"]["value"]) + abs(values["tip_y"]["value"]) == pytest.approx(0.45)
    said = {x["effect"]: x["reason"] for x in found["not_identifiable"]}
    assert said["fluid_drag"] == f"its size is that of a link whose end is a guess: {SAYS}"


def test_nothing_is_named_where_there_is_no_fluid(tmp_path: Path) -> None:
    found = answer(Case("levered2", 113), tmp_path / "case")
    assert found["causes"] == []
    assert found["verdict"] == "nothing_missing"
    said = {x["effect"]: x["reason"] for x in found["not_identifiable"]}
    assert said["fluid_drag"] == f"it is looked for as if the end were 0.45 m from the joint: {SAYS}"
