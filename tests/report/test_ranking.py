"""Every candidate of a turn says why it is no cause."""

from diagnosis_support import ARM

from modelgen.diagnosis.selection import Ranked
from modelgen.report.ranking import rankings

NONE = float("nan")


def test_a_candidate_that_meets_every_condition_is_behind_the_one_chosen() -> None:
    turn = [
        Ranked("load_dependent_friction", 2, 289.6, 11.0, 12.0, "", chosen=True),
        Ranked("torque_constant_saturation", 2, 163.6, 11.2, NONE, ""),
        Ranked("position_dependent_friction", 2, 33.6, 0.4, NONE, "gain"),
    ]
    ((heading, rows), (later, (other,))) = rankings(ARM, [turn, [Ranked("spring", 1, 20.0, 3.0, NONE, "")]])
    assert (heading, later) == ("Candidates", "Candidates beside what turn 1 chose")
    assert [row[-1] for row in rows] == [
        "chosen",
        "explains less than load_dependent_friction, by 126",
        "gains too little on records that its fit has not seen",
    ]
    assert rows[1][2:5] == ("163.6", "11.2", "")
    assert other[-1] == "meets every condition too"
