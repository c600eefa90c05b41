"""What the ranking says of causes that were taken and did not stay."""

from modelgen.diagnosis.selection.history import (
    EXCHANGED,
    SUSPECT,
    Ranked,
    best_of_each,
    taken_back,
)

SPRING, DELAY, DRY = ("spring", 1), ("time_delay", None), ("friction_offset", 1)


def entry(place: tuple[str, int | None], evidence: float, refused: str = "") -> Ranked:
    return Ranked(*place, evidence, 5.0, 5.0, refused)


def test_of_several_forms_the_one_that_came_farthest_is_shown() -> None:
    turn = best_of_each([entry(SPRING, 90.0, "gain"), entry(DELAY, 20.0), entry(SPRING, 60.0)], SPRING)
    assert [(r.place, r.delta_bic, r.chosen) for r in turn] == [(SPRING, 60.0, True), (DELAY, 20.0, False)]


def test_what_was_taken_back_says_why_in_its_own_turn_alone() -> None:
    turns = [
        best_of_each([entry(SPRING, 60.0), entry(DELAY, 50.0)], SPRING),
        best_of_each([entry(DELAY, 40.0)], DELAY),
    ]
    found = taken_back(turns, DELAY, SUSPECT)
    assert found[0] == turns[0]
    assert [(r.refused, r.chosen) for r in found[1]] == [(SUSPECT, True)]
    assert taken_back(turns, DRY, SUSPECT) == turns


def test_an_exchange_names_both() -> None:
    turns = [best_of_each([entry(SPRING, 60.0), entry(DELAY, 50.0), entry(DRY, 5.0, "evidence")], SPRING)]
    (turn,) = taken_back(turns, SPRING, EXCHANGED, DELAY)
    assert [(r.place, r.refused, r.chosen) for r in turn] == [
        (SPRING, EXCHANGED, False),
        (DELAY, "", True),
        (DRY, "evidence", False),
    ]
