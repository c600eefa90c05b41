"""Elastic joints and gaps have their own values, not those of the arm that was taken for rigid."""

from pathlib import Path

import numpy as np
import pytest
from hidden.cases import Case, Hidden
from hidden.judging import FOUND
from hidden.running import run_here

from modelgen.diagnosis.candidates.candidate import Candidate
from modelgen.diagnosis.candidates.fitted import FittedCandidate
from modelgen.diagnosis.evidence.likelihood import Evidence
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.diagnosis.selection.compliance import member
from modelgen.diagnosis.validation.conditions import Judgement

GAP = 0.004  # rad in the middle of the stroke, per unit of the plant's magnitude


def test_a_gap_comes_out_as_wide_as_it_is(tmp_path: Path) -> None:
    # the values that explain most beside the rigid arm's parameters: 0.00095 rad, and the extended arm then
    # predicts the test record no better than the rigid one
    size = 3.0678565382
    case = Case("mixed4", 3679181655, (Hidden("backlash", 3, 1.3, size),))
    outcome, answer = run_here(case, tmp_path / "case")
    assert outcome.result == FOUND, outcome
    play = answer["causes"][0]["parameters"]["play"]["value"]
    assert 0.7 * GAP * size < play < 1.4 * GAP * size


def test_a_gap_is_named_whose_first_values_explain_too_little(tmp_path: Path) -> None:
    case = Case("mixed4", 3637445377, (Hidden("backlash", 4, 1.1, 0.8640359577),))
    outcome, _ = run_here(case, tmp_path / "case")
    assert outcome.result == FOUND, outcome
    assert outcome.recovered is not None
    assert outcome.recovered > 0.5


@pytest.mark.parametrize(
    ("elastic", "gap", "named"),
    [
        ((900.0, 5.0), (903.0, 5.0), "joint_flexibility"),  # a gap of hardly any width is an elastic joint
        ((900.0, 5.0), (950.0, 5.0), "backlash"),
        ((900.0, 2.4), (840.0, 3.5), "backlash"),
        ((900.0, 7.2), (898.0, 7.8), "joint_flexibility"),
    ],
)
def test_of_an_elastic_joint_and_a_gap_the_simpler_one_is_taken_where_both_explain_as_much(
    elastic: tuple[float, float], gap: tuple[float, float], named: str
) -> None:
    pairs = [judged("joint_flexibility", 2, *elastic), judged("backlash", 2, *gap)]
    pairs.append(judged("backlash", 1, 700.0, 9.0))  # another joint's has no say
    pairs.sort(key=lambda pair: -pair[0].gain.delta_bic)
    trial, _ = member(pairs[0], pairs, USUAL)
    assert (trial.candidate.effect, trial.candidate.joint) == (named, 2)


def judged(effect: str, joint: int, delta_bic: float, gain: float) -> tuple[FittedCandidate, Judgement]:
    found = Evidence(delta_bic, np.ones(1), np.ones(1), np.ones(1), 1)
    return FittedCandidate(Candidate(effect, joint), {}, [], found), Judgement(gain, gain, "")
