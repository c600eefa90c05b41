"""What a diagnosis names and its extended description has is missing no more, in the same records.

The plants share no code with modelgen. Once these two are described, logs are read and equations made in
another way.
"""

from __future__ import annotations

from pathlib import Path

import pytest

import modelgen as mg
from hidden.cases import Case, Hidden, make
from hidden.running import trained

CASES = (
    Case("levered2", 1110, (Hidden("lever_geometry", 2, 1.3, 1.85877),)),
    Case("mixed3", 93895865, (Hidden("backlash", 1, 1.3, 0.04116825393556786),)),
)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.hidden[0].effect)
def test_what_was_named_is_missing_no_more(case: Case, tmp_path: Path) -> None:
    (hidden,) = case.hidden
    make(case, tmp_path)
    arm = mg.load_arms(tmp_path / "arms.yaml")[case.name]
    logs = trained(tmp_path), str(tmp_path / "test.csv")
    asked = [f"{hidden.effect}:{hidden.joint}"]
    first = mg.diagnose(arm, *logs, effects=asked, experiment=False, processes=1)
    assert [cause.effect for cause in first.causes] == [hidden.effect]
    again = mg.diagnose(first.extended_arm, *logs, experiment=False, processes=1)
    assert (again.verdict, again.suspects) == ("nothing_missing", ())
    assert not mg.identify(first.extended_arm, *logs).to_json()["doubts"]
