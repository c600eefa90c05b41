"""Coarse positions: known, priced, and never taken for a cause."""

from dataclasses import replace

import numpy as np
import pytest
from diagnosis_support import ARM, COUNT, coarse, three
from numpy.typing import NDArray

from modelgen.dataset import Record, prepare
from modelgen.dataset.processing.periods import other_period
from modelgen.diagnosis.equations import position_errors
from modelgen.diagnosis.equations.position_errors import blurred, counts, feigned, rounded
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.diagnosis.pipeline import diagnose
from modelgen.identification.rounded_positions import prepared_anew
from modelgen.numeric import Array

LIMITS = USUAL.equations


def test_the_count_is_found_where_there_is_one() -> None:
    record = three(None, 1, 0.0)[0]
    np.testing.assert_allclose(counts(coarse(record), LIMITS), COUNT, rtol=1e-6)
    assert not counts(record, LIMITS).any()
    seen = [coarse(r) for r in three(None, 1, 0.0)]
    error = np.concatenate([blurred(prepare(r), LIMITS).q - r.q for r in seen])
    assert 0.45 * COUNT < np.abs(error).max() <= 0.5 * COUNT
    # of one phase of the counts: where the motion turns back it stays long at one error
    np.testing.assert_allclose(error.std(axis=0), COUNT / np.sqrt(12), rtol=0.05)


def test_another_rounding_of_a_slow_motion_has_the_low_frequencies_of_its_own(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """They pass the low-pass of the equations; of errors that are drawn row by row a third does."""
    again, white = [], []
    for k, record in enumerate(three(None, 1, 0.0)):
        slow = replace(record, q=0.03 * record.q)
        seen, low = coarse(slow), np.fft.rfftfreq(len(slow.q), record.step) < 5.0

        def power(error: Array, low: NDArray[np.bool_] = low) -> float:
            return float((np.abs(np.fft.rfft(error - error.mean(axis=0), axis=0)[low]) ** 2).sum())

        own = power(seen.q - slow.q)
        for seed in range(4):
            monkeypatch.setattr(position_errors, "SEED", seed)
            again.append(power(blurred(prepare(seen), LIMITS).q - seen.q) / own)
        white.append(power(COUNT * np.random.default_rng(k).uniform(-0.5, 0.5, seen.q.shape)) / own)
    assert 0.7 < np.mean(again) < 1.4
    assert np.mean(white) < 0.4


def test_rounding_is_told_from_noise_that_is_rounded() -> None:
    record = three(None, 1, 0.0)[0]
    assert rounded(coarse(record), LIMITS).all()
    assert not rounded(record, LIMITS).any()  # no steps
    for size, alone in ((0.1, True), (1.0, False)):
        error = size * COUNT * np.random.default_rng(1).normal(size=record.q.shape)
        assert (rounded(coarse(replace(record, q=record.q + error)), LIMITS) == alone).all()


def test_what_errors_of_positions_can_feign() -> None:
    found = feigned(np.array([0.0, 0.19, 2.0]), np.array([1.0, 1.0, 1.0]))
    np.testing.assert_allclose(found, [0.0, 10.0, 100.0], atol=1e-9)


def test_coarse_positions_name_nothing_and_say_why() -> None:
    """Their errors are the larger part of what remains: nobody sees what else does."""
    records = [coarse(r, 2.0 * COUNT) for r in three(None, 1, 0.0, seed=4)]
    found = diagnose(ARM, records)
    assert found.verdict == "cannot_tell", found.causes
    assert "too coarse" in found.reason


def test_coarse_positions_hide_nothing_where_other_noise_is_larger_and_nothing_repeats() -> None:
    """Their errors could feign more than what counts, and have not."""
    records = [coarse(r, 0.6 * COUNT) for r in three(None, 1, 0.0, seed=4)]
    found = diagnose(ARM, records)
    assert found.positions.feigned.max() > 2.0 * USUAL.validation.min_gain_percent
    assert found.verdict == "nothing_missing"
    small = diagnose(ARM, [coarse(r, 0.6 * COUNT) for r in three("stribeck_friction", 1, 0.1, seed=4)])
    assert [(c.effect, c.joint) for c in small.causes] == [("stribeck_friction", 1)]


@pytest.mark.parametrize("effect", ["stribeck_friction", "friction_offset"])
def test_a_large_cause_is_among_those_named(effect: str) -> None:
    found = diagnose(ARM, [coarse(r) for r in three(effect, 1, 1.5, seed=5)])
    first = found.causes[0]
    assert (effect, 1) in {(first.effect, first.joint), *(rival[:2] for rival in first.ambiguous_with)}


def noisy(record: Record, size: float, seed: int) -> Record:
    """Seen by encoders whose noise has no steps, another one in every period."""
    q = record.q + size * np.random.default_rng(seed).normal(size=record.q.shape)
    return replace(record, q=q, motor=q * np.array([80.0, 60.0]), motor_side=(False, False))


def test_noise_without_steps_is_seen_by_instruments_and_drawn_as_large() -> None:
    exact = diagnose(ARM, three(None, 1, 0.0, seed=6))
    assert exact.positions is not None
    assert exact.positions.endogeneity is not None
    assert not exact.positions.endogeneity.found
    found = diagnose(ARM, [noisy(r, 2e-4, k) for k, r in enumerate(three(None, 1, 0.0, seed=6))])
    assert found.positions is not None
    assert found.positions.endogeneity is not None
    assert found.positions.endogeneity.found
    # what a draw of errors from the spectrum leaves, and what instruments say of the true ones
    assert found.positions.feigned == pytest.approx(found.positions.endogeneity.share, rel=0.2)
    assert (exact.positions.feigned < 1e-3).all()
    assert found.verdict == "cannot_tell", (found.verdict, found.causes)
    assert "too noisy" in found.reason


def test_the_other_period_has_the_same_phase() -> None:
    assert list(other_period(7, 3)) == [3, 4, 5, 6, 1, 2, 3]
    assert list(other_period(4, 3)) == [3, -1, -1, 0]


def test_a_record_that_is_read_anew_runs_on_from_what_it_did() -> None:
    """Heat that a drive keeps from one record to the next is no error of the positions."""
    first, second = (prepare(coarse(record)) for record in three(None, 1, 0.0)[:2])
    assert prepared_anew(replace(second, before=first), 0).before is first
