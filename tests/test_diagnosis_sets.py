"""What may be there instead of what is named is in its ambiguity set, though it could not be named itself."""

from pathlib import Path

import pytest
from hidden.cases import Case, Hidden
from hidden.running import run

# Evidence of 10 for an actuator's mass, of 6 for the lever; and a delay beside a joint that sticks.
FAINT = Case("mixed3", 1665929978, (Hidden("lever_geometry", 3, 1.05, 0.373803379736),))
LATE = Case("mixed2", 2850154501, (Hidden("time_delay", 2, 1.05, 1.954201570986),))


@pytest.mark.parametrize("case", [FAINT, LATE], ids=lambda case: case.hidden[0].effect)
def test_the_truth_is_in_the_set(case: Case, tmp_path: Path) -> None:
    outcome, _, _ = run(case, tmp_path / "case")
    assert outcome.in_set, outcome
    assert outcome.size <= 3
