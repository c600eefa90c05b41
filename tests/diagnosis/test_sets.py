"""What may be there instead of what is named is in its ambiguity set, though it could not be named itself."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from diagnosis_support import equations_of
from hidden.cases import Case, Hidden, make
from hidden.running import diagnosed_here

from modelgen.diagnosis.candidates.candidate import Candidate
from modelgen.diagnosis.candidates.fitted import FittedCandidate
from modelgen.diagnosis.evidence.likelihood import Evidence
from modelgen.diagnosis.options.thresholds import SelectionThresholds
from modelgen.diagnosis.selection.rivals import imitated, lesser_rivals, needed_behind
from modelgen.diagnosis.validation.conditions import Judgement
from modelgen.effects import CATALOGUE


def test_coarse_positions_do_not_tell_a_lever_from_a_torque_constant(tmp_path: Path) -> None:
    """Errors of the positions put the wrong one of two ahead by 3 of 155 of evidence."""
    case = Case("mixed4", 79368935, (Hidden("lever_geometry", 2, 1.3, 4.598426492040),), "coarse")
    make(case, tmp_path / "case")
    answer = diagnosed_here(tmp_path / "case", case.name)
    assert answer["verdict"] == "cannot_tell"
    assert answer["causes"] == []
    assert "drive_gain_error at j2" in answer["reason"]
    assert "lever_geometry at j2" in answer["reason"]


def test_rounding_that_by_chance_leaves_more_than_a_draw_of_it_is_no_delay(tmp_path: Path) -> None:
    """What follows the errors at joint 1 gains 5.4 %, and a draw of them could feign 5.2 %."""
    hidden = (Hidden("asymmetric_viscous_friction", 2, 1.3, 2.396727079478),)
    case = Case("mixed4", 2321734202, hidden, "coarse", train=4)
    make(case, tmp_path / "case")
    answer = diagnosed_here(tmp_path / "case", case.name)
    assert [(c["effect"], c["joint"]) for c in answer["causes"]] == [("asymmetric_viscous_friction", 2)]


def tried(effect: str, delta_bic: float) -> FittedCandidate:
    return FittedCandidate(
        Candidate(effect, 1), {}, [], Evidence(delta_bic, np.ones(1), np.ones(1), np.ones(1), 1)
    )


def test_what_is_too_faint_to_be_named_where_the_best_has_little_more() -> None:
    shut = "friction_offset"
    gates: Any = SimpleNamespace(
        equations=equations_of([]),
        judged=lambda t: Judgement(3.0, 3.0, "gain" if t.candidate.effect == shut else ""),
    )
    faint = [tried("lever_geometry", 5.0), tried(shut, 5.5)]

    def rivals(best: FittedCandidate) -> list[tuple[str, float]]:
        found = lesser_rivals(best, faint, gates)
        return [(t.candidate.effect, behind) for t, behind in found]

    assert rivals(tried("actuator_mass", 12.0)) == [("lever_geometry", 7.0)]
    assert rivals(tried("actuator_mass", 40.0)) == []  # too far ahead


def test_a_power_of_the_speed_at_the_end_of_its_range_gives_way_to_friction_near_rest() -> None:
    """|v|^0.3 is dry friction that is lower near rest, not one that grows with the speed."""
    effect = "nonlinear_viscous_friction"
    searched = tuple(p for p in CATALOGUE[effect].nonlinear if p.name == "exponent")
    passed = Judgement(9.0, 9.0, "")

    def gives_way(exponent: float, beside: FittedCandidate) -> bool:
        trial = replace(
            tried(effect, 1654.0),
            candidate=Candidate(effect, 1, searched=searched),
            values={"exponent": exponent},
        )
        pair = trial, passed
        return imitated(pair, [pair, (beside, passed)])

    assert gives_way(0.3, tried("presliding", 1052.0))
    assert gives_way(0.301, tried("stribeck_friction", 20.0))
    assert not gives_way(0.35, tried("presliding", 1052.0))
    assert not gives_way(0.3, tried("spring", 1052.0))
    other = replace(tried("presliding", 1052.0), candidate=Candidate("presliding", 2))
    assert not gives_way(0.3, other)


def test_play_and_elasticity_are_told_apart_by_more_of_more_evidence() -> None:
    """A contact that hardens is neither, and of evidence in thousands its form leaves dozens."""
    elastic, gap = tried("joint_flexibility", 2600.0), tried("backlash", 2560.0)
    limits = SelectionThresholds()
    needed = needed_behind(elastic, gap, limits)
    assert needed == needed_behind(replace(gap, gain=elastic.gain), elastic, limits) > 40.0
    assert needed_behind(elastic, tried("presliding", 2560.0), limits) == limits.rival_margin_bic
    few = tried("backlash", 300.0), tried("joint_flexibility", 250.0)
    assert needed_behind(*few, limits) == limits.rival_margin_bic
