"""Friction by all that a transmission carries, or by the links' weight alone: which it is, is found."""

from pathlib import Path

import pytest
from hidden.cases import Case, Hidden, make
from hidden.running import diagnosed_here


@pytest.mark.parametrize(("carried", "magnitude"), [(True, 0.3398), (False, 0.5)])
def test_what_the_friction_follows_is_found(*, carried: bool, magnitude: float, tmp_path: Path) -> None:
    hidden = Hidden("load_dependent_friction", 2, 1.3, magnitude, carried=carried)
    case = Case("direct2", 22, (hidden,), train=2)
    label = make(case, tmp_path)
    found = diagnosed_here(tmp_path, case.name)
    (cause,) = found["causes"]
    assert (cause["effect"], cause["joint"]) == ("load_dependent_friction", 2)
    assert ("rise" in cause["parameters"]) is carried
    assert cause["parameters"]["coefficient"]["value"] == pytest.approx(0.1 * magnitude, rel=0.1)
    before, after = found["error"]["before"][1], found["error"]["after"][1]
    assert after - label.floor[1] < 0.1 * (before - label.floor[1])
    # the extended model simulates the motion better, not only the inputs
    motion = (found["simulation"][side]["rmse"][1] for side in ("after", "before"))
    assert next(motion) < next(motion)
