"""What each cause takes away on the test record."""

from dataclasses import replace

import numpy as np
import pytest
from diagnosis_support import ARM, record, three
from numpy.random import default_rng

from modelgen.dataset import Record
from modelgen.diagnosis.extended.test_errors import compared
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.diagnosis.pipeline import diagnose
from modelgen.diagnosis.result import to_json
from modelgen.report.diagnosis import report
from modelgen.report.diagnosis_sentences import harms

RIPPLE, OFFSET = ("torque_ripple", 1, 0.02), ("friction_offset", 2, 0.04)


def both(seed: int, ripple: float = 1.0) -> Record:
    """With a ripple at joint 1, so many times as large as in the others, and an offset at joint 2."""
    effect, joint, size = RIPPLE
    one = record(effect, joint, ripple * size, seed, f"r{seed}")
    given = [r.input for r in (one, record(*OFFSET, seed, ""), record(None, 1, 0.0, seed, ""))]
    return replace(one, input=np.tensordot([1.0, 1.0, -1.0], np.array(given), 1))


def test_the_only_cause_has_the_whole_gain() -> None:
    found = diagnose(ARM, three(*RIPPLE))
    (cause,), at = found.causes, RIPPLE[1] - 1
    assert cause.share.gain == pytest.approx(found.errors.gain[at], rel=0.02)
    assert 0.0 < cause.share.low < cause.share.gain < cause.share.high
    assert harms(found) == []


def test_each_of_two_has_its_joint_s() -> None:
    found = diagnose(ARM, [both(k) for k in range(3)])
    assert {(c.effect, c.joint) for c in found.causes} == {RIPPLE[:2], OFFSET[:2]}
    for cause in found.causes:
        assert cause.joint is not None
        assert cause.share.gain == pytest.approx(found.errors.gain[cause.joint - 1], rel=0.05)


def test_what_does_harm_there_is_said_and_kept() -> None:
    """The ripple of the test record is turned by half a wave, as another zero of the motor turns it."""
    found = diagnose(ARM, [both(0), both(1), both(2, -1.0)])
    shares = {c.effect: c.share for c in found.causes}
    assert shares["torque_ripple"].high < 0.0 < shares["friction_offset"].low
    assert shares["torque_ripple"].gain == pytest.approx(found.errors.gain[0], rel=0.05)
    (said,) = harms(found)
    assert "torque_ripple at j1" in said
    assert said in report(found)
    told = to_json(found)["error"]["by_cause"]
    assert [c["effect"] for c in told if c["gain_interval_percent"][1] < 0.0] == ["torque_ripple"]


@pytest.mark.parametrize(("rows", "interval"), [(400, True), (12, False)])
def test_a_short_test_record_has_errors_and_no_interval(rows: int, interval: bool) -> None:
    before = default_rng(5).normal(size=rows)
    old, new, gain, low, high = compared(before, 0.5 * before, USUAL.extended)
    assert (old, new) == pytest.approx((np.sqrt((before**2).mean()), 0.5 * old))
    assert gain == pytest.approx(50.0)
    assert np.isfinite([low, high]).all() == interval
    assert np.isnan(compared(before[:0], before[:0], USUAL.extended)).all()
