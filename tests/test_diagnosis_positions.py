"""Coarse positions: known, priced, and never taken for a cause."""

from dataclasses import replace

import numpy as np
import pytest
from test_diagnosis_selection import ARM, three

from modelgen.dataset import Record
from modelgen.diagnosis.positions import blurred, counts, feigned
from modelgen.diagnosis.run import diagnose

COUNT = 2 * np.pi / 2**13


def coarse(record: Record) -> Record:
    """Seen by encoders at the joints."""
    q = np.round(record.q / COUNT) * COUNT
    return replace(record, q=q, motor=q * np.array([80.0, 60.0]), motor_side=(False, False))


def test_the_count_is_found_where_there_is_one() -> None:
    record = three(None, 1, 0.0)[0]
    np.testing.assert_allclose(counts(coarse(record)), COUNT, rtol=1e-6)
    assert not counts(record).any()
    error = blurred(coarse(record)).q - coarse(record).q
    assert 0.45 * COUNT < np.abs(error).max() <= 0.5 * COUNT
    np.testing.assert_allclose(error.std(axis=0), COUNT / np.sqrt(12), rtol=0.03)


def test_what_errors_of_positions_can_feign() -> None:
    found = feigned(np.array([0.0, 0.19, 2.0]), np.array([1.0, 1.0, 1.0]))
    np.testing.assert_allclose(found, [0.0, 10.0, 100.0], atol=1e-9)


def test_coarse_positions_name_nothing_and_say_why() -> None:
    records = [coarse(r) for r in three(None, 1, 0.0, seed=4)]
    found = diagnose(ARM, records)
    assert found.verdict == "cannot_tell", found.causes
    assert "too coarse" in found.reason


@pytest.mark.parametrize("effect", ["stribeck_friction", "friction_offset"])
def test_a_large_cause_is_among_those_named(effect: str) -> None:
    found = diagnose(ARM, [coarse(r) for r in three(effect, 1, 1.5, seed=5)])
    first = found.causes[0]
    assert (effect, 1) in {(first.effect, first.joint), *(rival[:2] for rival in first.ambiguous_with)}
