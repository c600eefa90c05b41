"""Causes whose law is not the catalogue's, and bands that are lost at another joint: named all the same."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from diagnosis_support import BARE
from hidden.cases import Case, Hidden
from hidden.judging import FOUND
from hidden.running import run_here

from modelgen.diagnosis.equations.rows import Rows
from modelgen.diagnosis.options.thresholds import ValidationThresholds
from modelgen.diagnosis.validation.cross_validation import Split, folds

# A wave of friction over the joint, tried as a parabola on records that pass different parts of it.
WAVE = Case(
    "direct3",
    831887608,
    (Hidden("position_dependent_friction", 2, 1.15, 0.836377), Hidden("added_mass", 3, 1.15, 0.18990878)),
)
# A spring that hardens: what a linear one leaves has waves over the motor's turns.
HARDENING = Case("pendulum2", 682528160, (Hidden("spring", 2, 1.3, 0.006654524),))
# Counts of the encoder could feign somewhat more than what counts, at the first joint.
RIPPLE = Case("direct3", 2579679106, (Hidden("torque_ripple", 3, 1.05, 0.105554707),))


@pytest.mark.parametrize("case", [WAVE, HARDENING, RIPPLE], ids=lambda case: case.hidden[0].effect)
def test_the_cause_and_nothing_else_is_named(case: Case, tmp_path: Path) -> None:
    outcome, _ = run_here(case, tmp_path / "case")
    assert outcome.result == FOUND, outcome


MOST = ValidationThresholds().max_records_one_by_one


def at(q: list[float]) -> Rows:
    prepared: Any = SimpleNamespace(q=np.array(q)[:, None], rows=np.arange(len(q)))
    return Rows(prepared, np.zeros((len(q), 1)), np.zeros((len(q), 1, 0)), np.ones((len(q), 1), bool), BARE)


def test_a_law_of_the_position_is_tried_where_its_fit_has_been() -> None:
    one, other, far = at([0.0, 1.0, 2.0]), at([1.5, 2.5, 0.5]), at([7.0, 8.0])

    def tried(rows: list[Rows], split: Split) -> list[list[bool]]:
        return [list(r.moving[:, 0]) for _, (part, _) in folds(rows, split) for r in part]

    assert tried([one, other], Split(MOST, within=0)) == [[False, True, True], [True, False, True]]
    assert tried([one, other], Split(MOST)) == [[True] * 3] * 2
    assert tried([one, far], Split(MOST, within=0)) == [[False] * 3, [False] * 2]
