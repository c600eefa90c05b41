"""Conditions on equations of which everything is known: no arm, no filter, white noise."""

from dataclasses import replace

import numpy as np
import pytest
from diagnosis_support import BARE, UNUSED, system_of
from numpy.random import Generator, default_rng
from scipy.optimize import lsq_linear

from modelgen.diagnosis.candidates.candidate import Candidate
from modelgen.diagnosis.candidates.fitted import FittedCandidate
from modelgen.diagnosis.equations.rows import Rows
from modelgen.diagnosis.evidence.likelihood import not_negative
from modelgen.diagnosis.validation.conditions import Conditions, Judgement
from modelgen.numeric import Array
from modelgen.regression.weighted import rmse, weighted_fit

LONG, UNKNOWNS = 300, 6


def record(random: Generator, size: float) -> tuple[Rows, Array]:
    """One joint. A column that others take up in part, and differently in every record."""
    slow = random.normal(size=(LONG, UNKNOWNS))
    own = slow @ random.normal(size=(UNKNOWNS, 1)) / np.sqrt(UNKNOWNS) + 0.6 * random.normal(size=(LONG, 1))
    effort = slow @ np.ones((UNKNOWNS, 1)) + size * own + random.normal(size=(LONG, 1))
    return Rows(UNUSED, effort, slow[:, None, :], np.ones((LONG, 1), dtype=bool), BARE), own[:, None, :]


def gains(random: Generator, size: float) -> tuple[float, float, float]:
    """Expected and measured gain [%] from two records, and what it is on twenty others."""
    made = [record(random, size) for _ in range(22)]
    rows, columns = [r for r, _ in made], [c for _, c in made]
    system = system_of(rows[:2], periods=[LONG // 3] * 2)
    gain = system.gain(columns[:2])
    assert gain is not None
    trial = FittedCandidate(Candidate("friction_offset", 1), {}, columns[:2], gain)
    found = Conditions(system, []).judged(trial)
    both = [np.concatenate([r.columns, c], axis=2) for r, c in zip(rows, columns, strict=True)]
    left = []
    for tables in ([r.columns for r in rows], both):
        squares = [
            rmse(rows[2:], tables[2:], weighted_fit(rows[k : k + 1], tables[k : k + 1]))[0] ** 2
            for k in range(2)
        ]
        left.append(np.sqrt(np.mean(squares)))
    return found.expected, found.gain, float(100 * (1 - left[1] / left[0]))


@pytest.mark.parametrize("size", [0.4, 0.8])
def test_expected_gain_is_what_other_records_show(size: float) -> None:
    """In the median over draws, and so is the measured one."""
    expected, measured, truth = np.median([gains(default_rng([7, k]), size) for k in range(20)], axis=0)
    assert expected == pytest.approx(truth, rel=0.25)
    assert measured == pytest.approx(truth, rel=0.25)


def test_what_is_not_there_is_expected_to_gain_nothing() -> None:
    """Where the evidence would not stop it."""
    table = np.array([gains(default_rng([9, k]), 0.0)[0] for k in range(20)])
    assert np.median(table) < 0.5


def test_values_that_may_not_be_negative() -> None:
    """Against SciPy's bounded least squares, also where columns are nearly the same."""
    random = default_rng(1)
    for _ in range(200):
        matrix = random.normal(size=(4, 4))
        matrix[:, 1] = matrix[:, 0] + 0.01 * random.normal(size=4)
        right = random.normal(size=4)
        limited = np.flatnonzero(random.uniform(size=4) < 0.6)
        low = np.full(4, -np.inf)
        low[limited] = 0.0
        witness = lsq_linear(matrix, right, (low, np.inf), tol=1e-14).x
        found = not_negative(matrix, right, limited)
        assert (found[limited] >= 0).all()
        left = [np.linalg.norm(right - matrix @ x) for x in (found, witness)]
        assert left[0] <= left[1] * (1 + 1e-9) + 1e-12


def judged(seed: int, sizes: tuple[float, float]) -> Judgement:
    """Of a cause of these sizes in two records that hardly tell it from forty other unknowns."""
    random = default_rng([13, seed])
    mixing = random.normal(size=(2, 40, 1)) / np.sqrt(40)
    rows, columns = [], []
    for size, mix in zip(sizes, mixing, strict=True):
        slow = random.normal(size=(LONG, 40))
        own = slow @ mix + 0.35 * random.normal(size=(LONG, 1))
        effort = slow @ np.ones((40, 1)) + size * own + random.normal(size=(LONG, 1))
        rows.append(Rows(UNUSED, effort, slow[:, None, :], np.ones((LONG, 1), dtype=bool), BARE))
        columns.append(own[:, None, :])
    system = system_of(rows, [r.columns for r in rows], [LONG // 3] * 2)
    gain = system.gain(columns)
    assert gain is not None
    return Conditions(system, []).judged(FittedCandidate(Candidate("friction_offset", 1), {}, columns, gain))


def test_a_cause_that_one_record_contradicts_is_refused() -> None:
    """Of 1.0 in both it passes; of 1.5 and -0.5, which together look like it, it does not."""
    same, other = ([judged(k, sizes) for k in range(20)] for sizes in ((1.0, 1.0), (1.5, -0.5)))
    assert [j.refused for j in same].count("") >= 19
    assert {j.refused for j in other} == {"gain"}


def test_what_the_form_of_a_law_leaves_between_records_does_not_refuse_it() -> None:
    """A tenth of the value, however significant it is in many rows."""
    assert [judged(k, (4.2, 3.8)).refused for k in range(20)].count("") >= 19


def play_judged(seed: int, shown: float, there: tuple[float, float]) -> Judgement:
    """Of play whose columns are this much in the first record, of what they are in the second, and that is
    there to this extent in each. What a column of it has in the first beside impacts is not quite right.
    """
    random = default_rng([19, seed])
    rows, columns = [], []
    for size, share in zip(there, (shown, 1.0), strict=True):
        slow = random.normal(size=(LONG, 1))
        own = share * random.normal(size=(LONG, 1))
        effort = slow + size * own + random.normal(size=(LONG, 1))
        rows.append(Rows(UNUSED, effort, slow[:, None, :], np.ones((LONG, 1), dtype=bool), BARE))
        columns.append(own[:, None, :])
    system = system_of(rows, [r.columns for r in rows], [LONG // 3] * 2)
    gain = system.gain(columns)
    assert gain is not None
    return Conditions(system, []).judged(FittedCandidate(Candidate("backlash", 1), {}, columns, gain))


def test_a_record_without_impacts_does_not_speak_against_play() -> None:
    """One with impacts as strong as elsewhere, where none are found, does."""
    hardly, contradicting = ([play_judged(k, *x) for k in range(20)] for x in ((0.1, (0, 1)), (1, (0, 0.5))))
    assert {j.refused for j in hardly} == {""}
    assert {j.refused for j in contradicting} == {"gain"}


def beside(
    before: dict[str, float],
    effect: str = "friction_offset",
    size: float = 0.5,
    evidence: float | None = None,
) -> Judgement:
    """Of a cause of this size against the noise, with others of these sizes taken before it.

    evidence: instead of what it has.
    """
    random = default_rng(17)
    sizes = [*before.values(), size]
    rows: list[Rows] = []
    tables: list[list[Array]] = [[] for _ in sizes]
    for _ in range(2):
        slow, own = random.normal(size=(LONG, UNKNOWNS)), random.normal(size=(LONG, len(sizes)))
        effort = (
            slow @ np.ones((UNKNOWNS, 1)) + own @ np.array(sizes)[:, None] + random.normal(size=(LONG, 1))
        )
        rows.append(Rows(UNUSED, effort, slow[:, None, :], np.ones((LONG, 1), dtype=bool), BARE))
        for k, table in enumerate(tables):
            table.append(own[:, [k]][:, None, :])
    trials, columns = [], [r.columns for r in rows]
    for name, table in zip([*before, effect], tables, strict=True):
        system = system_of(rows, columns, [LONG // 3] * 2)
        gain = system.gain(table)
        assert gain is not None
        trials.append(FittedCandidate(Candidate(name, None), {}, table, gain))
        columns = [np.concatenate([c, t], axis=2) for c, t in zip(columns, table, strict=True)]
    if evidence is not None:
        trials[-1] = replace(trials[-1], gain=replace(trials[-1].gain, delta_bic=evidence))
    return Conditions(system, trials[:-1]).judged(trials[-1])


def test_beside_a_fluid_a_cause_is_more_than_its_law_may_leave() -> None:
    """A twentieth of what the fluid explains, not of what others do: one value stands for all links."""
    assert beside({"lever_geometry": 10.0}).refused == ""
    assert beside({"added_mass": 10.0}).refused == "gain"
    assert beside({"added_mass": 0.5}).refused == ""
    assert beside({"added_mass": 0.5, "lever_geometry": 10.0}).refused == ""


def test_beside_what_swings_a_cause_is_more_than_its_simulation_may_leave() -> None:
    """A tenth of what that explains; friction is nothing like it."""
    assert beside({"joint_flexibility": 5.0}, size=1.5).refused == "gain"
    assert beside({"joint_flexibility": 5.0}, size=2.5).refused == ""
    assert beside({"joint_flexibility": 5.0}, "stribeck_friction", size=0.5).refused == ""
    assert beside({"joint_flexibility": 0.5}).refused == ""


def test_a_delay_beside_what_acts_at_reversals_is_more_than_the_form_of_that_leaves() -> None:
    assert 1.5 < beside({}, "time_delay", 0.16).gain < 3.0
    assert beside({}, "time_delay", 0.16).refused == ""
    assert 3.0 < beside({"stribeck_friction": 0.3}, "time_delay", 0.27).gain < 5.0
    assert beside({"stribeck_friction": 0.3}, "time_delay", 0.27).refused == "gain"
    assert beside({"stribeck_friction": 0.3}, "time_delay", 0.4).refused == ""


def test_presliding_beside_stribeck_is_more_than_the_form_of_that_leaves() -> None:
    """Both act at reversals."""
    assert 3.0 < beside({"stribeck_friction": 0.3}, "presliding", 0.27).gain < 5.0
    assert beside({"stribeck_friction": 0.3}, "presliding", 0.27).refused == "gain"
    assert beside({"stribeck_friction": 0.3}, "presliding", 0.4).refused == ""
    assert beside({"friction_offset": 0.3}, "presliding", 0.27).refused == ""


@pytest.mark.parametrize("size", [0.09, 0.105, 0.12, 0.14, 0.15, 0.18])
def test_the_fainter_a_cause_the_more_it_must_promise(size: float) -> None:
    """From 3 % at an evidence of 6 to 1.5 % at 15: what passes with some evidence passes with more."""
    expected = beside({}, size=size, evidence=50.0).expected
    passed = [beside({}, size=size, evidence=e).refused == "" for e in (5.0, 8.0, 10.5, 13.0, 16.0)]
    assert passed == [expected >= least for least in (3.0, 2.667, 2.25, 1.833, 1.5)]
