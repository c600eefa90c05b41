"""Elastic joints and gaps have their own values, not those of the arm that was taken for rigid."""

import json
from pathlib import Path

from hidden.cases import Case, Hidden
from hidden.judging import FOUND
from hidden.running import run

GAP = 0.004  # rad in the middle of the stroke, per unit of the plant's magnitude


def test_a_gap_comes_out_as_wide_as_it_is(tmp_path: Path) -> None:
    # the values that explain most beside the rigid arm's parameters: 0.00095 rad, and the extended arm then
    # predicts the test record no better than the rigid one
    size = 3.0678565382
    case = Case("mixed4", 3679181655, (Hidden("backlash", 3, 1.3, size),))
    outcome, _, _ = run(case, tmp_path / "case")
    assert outcome.result == FOUND, outcome
    answer = json.loads((tmp_path / "case" / "diagnosis" / "diagnosis.json").read_text(encoding="utf-8"))
    play = answer["causes"][0]["parameters"]["play"]["value"]
    assert 0.7 * GAP * size < play < 1.4 * GAP * size


def test_a_gap_is_named_whose_first_values_explain_too_little(tmp_path: Path) -> None:
    case = Case("mixed4", 3637445377, (Hidden("backlash", 4, 1.1, 0.8640359577),))
    outcome, _, _ = run(case, tmp_path / "case")
    assert outcome.result == FOUND, outcome
    assert outcome.recovered is not None
    assert outcome.recovered > 0.5
