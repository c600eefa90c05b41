"""A rival takes the place of a cause where all causes together explain more with it."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from diagnosis_support import ARM, cubic, equations_of, made, offset, system_of

from modelgen.diagnosis.candidates.candidate import Candidate
from modelgen.diagnosis.candidates.fitted import FittedCandidate
from modelgen.diagnosis.equations import Equations, Rows, Unknowns
from modelgen.diagnosis.selection.backward import measured
from modelgen.diagnosis.selection.cause import Cause, together
from modelgen.diagnosis.selection.exchange import exchanged
from modelgen.evaluation import Evaluator
from modelgen.numeric import Array


def scene() -> tuple[list[Rows], list[int | None], Any]:
    """Records with an offset and a cubic force, and what makes a trial of a law that was taken first."""
    rows, q, periods = made(lambda x: offset(x) + 0.2 * cubic(x))
    rows = [replace(r, baseline=Unknowns(np.zeros(2), np.eye(2))) for r in rows]
    bare = system_of(rows, [r.columns for r in rows], periods)

    def trial(effect: str, law: Any) -> FittedCandidate:
        columns: list[Array] = [law(x[:, 0])[:, None, None] for x in q]
        gain = bare.gain(columns)
        assert gain is not None
        return FittedCandidate(Candidate(effect, 1), {}, columns, gain)

    return rows, periods, trial


def of_bench(rows: list[Rows], periods: list[int | None]) -> Equations:
    """They ask the evaluator which columns follow from an arm's parameters."""
    return replace(equations_of(rows, periods), evaluator=Evaluator(ARM))


def test_the_law_that_is_there_takes_the_place_of_one_like_it() -> None:
    """Beside the other cause it is ahead, whatever the evidence at its turn was."""
    rows, periods, trial = scene()
    first = trial("asymmetric_viscous_friction", lambda x: np.tanh(x) ** 2)
    right, second = trial("friction_offset", offset), trial("nonlinear_viscous_friction", cubic)
    causes = [Cause(first, 30.0, 5.0, 5.0, [(right, 4.0)]), Cause(second, 30.0, 5.0, 5.0)]
    found = exchanged(causes, of_bench(rows, periods))
    assert found is not None
    assert [c.trial.candidate.effect for c in found] == ["friction_offset", "nonlinear_viscous_friction"]
    ((rival, behind),) = found[0].rivals
    assert rival is first
    assert behind > 0.0


@pytest.mark.parametrize("places", [1, 3])
def test_the_places_of_an_effect_share_its_odds(places: int) -> None:
    """An effect that may be at three places is at each a third as likely as one that has a single place: of
    causes that explain as much it must explain as much more, and no more than that.
    """
    rows, periods, trial = scene()
    bare = system_of(rows, [r.columns for r in rows], periods)
    right, second = trial("friction_offset", offset), trial("nonlinear_viscous_friction", cubic)
    right = replace(right, candidate=replace(right.candidate, places=places))
    due = 2 * math.log(places)
    seen = []
    for bend in np.geomspace(1e-3, 1.0, 60):
        worse = trial("asymmetric_viscous_friction", lambda x, bend=bend: offset(x) + bend * x**2)
        ahead = together([right, second], bare) - together([worse, second], bare)
        if due - 2.0 < ahead < due + 2.0 and abs(ahead - due) > 0.05:
            causes = [Cause(worse, 30.0, 5.0, 5.0, [(right, 0.0)]), Cause(second, 30.0, 5.0, 5.0)]
            found = exchanged(causes, of_bench(rows, periods))
            assert (found is None) == (ahead < due), ahead
            if found is not None:
                assert found[0].rivals[0][1] == pytest.approx(ahead)  # evidence, whatever the places
            seen.append(ahead - due)
    assert max(seen) > 1.0
    assert places == 1 or min(seen) < -1.0


def test_a_rival_that_explains_less_stays_one() -> None:
    rows, periods, trial = scene()
    right, other = (
        trial("friction_offset", offset),
        trial("asymmetric_viscous_friction", lambda x: np.tanh(x) ** 2),
    )
    causes = [
        Cause(right, 30.0, 5.0, 5.0, [(other, 4.0)]),
        Cause(trial("nonlinear_viscous_friction", cubic), 30.0, 5.0, 5.0),
    ]
    assert exchanged(causes, of_bench(rows, periods)) is None
    assert exchanged(causes[1:], of_bench(rows, periods)) is None  # no rivals, nothing to do


def test_a_cause_that_took_another_ones_place_has_its_own_evidence_and_gain() -> None:
    rows, periods, trial = scene()
    right, second = trial("friction_offset", offset), trial("nonlinear_viscous_friction", cubic)
    causes = [Cause(right, 30.0, -5.0, -5.0), Cause(second, 30.0, 5.0, 5.0)]
    system = system_of(
        rows,
        [
            np.concatenate([r.columns, *pair], axis=2)
            for r, *pair in zip(rows, right.columns, second.columns, strict=True)
        ],
        periods,
    )
    found = measured(causes[0], causes, system)
    beside = [np.concatenate([r.columns, c], axis=2) for r, c in zip(rows, second.columns, strict=True)]
    own = system_of(rows, beside, periods).gain(right.columns)
    assert own is not None
    assert found.delta_bic == own.delta_bic
    # an offset of 0.6 against noise of unit size: 1 - 1 / sqrt(1.36), less what the spring takes of it
    assert 5.0 < found.expected_gain < 14.3
