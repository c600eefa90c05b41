"""The diagnosis on records made of the model itself: what was put in comes out, and nothing else."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from diagnosis_support import ARM, three

from modelgen.dataset import Record
from modelgen.diagnosis.candidates.candidate import Candidate
from modelgen.diagnosis.candidates.fitted import FittedCandidate
from modelgen.diagnosis.evidence.likelihood import Evidence
from modelgen.diagnosis.options.thresholds import SelectionThresholds
from modelgen.diagnosis.pipeline import diagnose
from modelgen.diagnosis.result import to_json
from modelgen.diagnosis.selection.rivals import at_one_joint
from modelgen.diagnosis.validation.conditions import Judgement
from modelgen.errors import InputError
from modelgen.evaluation import with_effect


@pytest.mark.parametrize(
    ("effect", "joint", "size"),
    [
        ("stribeck_friction", 2, 0.02),
        ("friction_offset", 1, 0.04),
        ("spring", 2, 1.2),
        ("load_dependent_friction", 1, 0.2),
        ("torque_ripple", 1, 0.02),
    ],
)
def test_what_was_put_in_is_named_and_the_gain_measured(effect: str, joint: int, size: float) -> None:
    found = diagnose(ARM, three(effect, joint, size))
    assert found.verdict == "named"
    assert [(c.effect, c.joint) for c in found.causes] == [(effect, joint)]
    assert found.errors.gain[joint - 1] > 1.5
    assert found.errors.low[joint - 1] > 0.0
    name = {"stribeck_friction": "magnitude", "friction_offset": "offset", "spring": "stiffness"}.get(effect)
    if name:
        estimate = found.causes[0].parameters[name]
        assert abs(estimate.value - size) < 4 * estimate.std + 0.05 * size
    uses = found.after.arm.joints[joint - 1].effects
    assert effect in {use.name for use in uses}
    assert to_json(found)["causes"][0]["evidence"]["delta_bic"] > 15


def test_friction_that_the_description_lacks_is_no_variation_of_it() -> None:
    """A warm-up holds a constant part, which alone has more evidence here than dry friction has by itself."""
    first, second = ARM.joints
    viscous = tuple(use for use in second.effects if use.name != "coulomb_friction")
    arm = replace(ARM, joints=(first, replace(second, effects=viscous)))
    found = diagnose(arm, [replace(r, arm=arm) for r in three(None, 1, 0.0, 1)])
    (cause,) = found.causes
    assert (cause.effect, cause.joint) == ("coulomb_friction", 2)
    assert all(check.passed for check in cause.checks if check.decides)
    assert 2 not in [joint for _, joint, _ in cause.ambiguous_with]


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_nothing_is_named_where_nothing_was_put_in(seed: int) -> None:
    found = diagnose(ARM, three(None, 1, 0.0, seed))
    assert found.verdict == "nothing_missing"
    assert found.lack_of_fit is not None
    assert found.lack_of_fit.periods == 3
    assert found.lack_of_fit.statistic < found.lack_of_fit.threshold
    np.testing.assert_array_equal(found.errors.before, found.errors.after)


def test_without_repetition_nothing_can_be_said() -> None:
    records = [replace_part(r, 0, 2200) for r in three(None, 1, 0.0, 4)]
    found = diagnose(ARM, records)
    assert found.verdict == "cannot_tell"
    assert "--period" in found.reason


def replace_part(r: Record, begin: int, end: int) -> Record:
    return r.part(begin, end, r.name)


@pytest.mark.parametrize(
    ("effect", "joint", "values"),
    [("encoder_offset", 1, {"offset": 0.02}), ("base_tilt", None, {"x": 0.01, "y": 0.0})],
)
def test_what_is_described_already_is_not_asked_for(
    effect: str, joint: int | None, values: dict[str, float]
) -> None:
    """Geometry that is off is a part of the model, though none of its parameters."""
    arm = with_effect(ARM, effect, joint, values)
    records = [replace(r, arm=arm) for r in three(None, 1, 0.0, 4)]
    with pytest.raises(InputError, match="has it already"):
        diagnose(arm, records, effects=[(effect, joint)])


def test_an_effect_that_is_there_already_is_not_named_again(tmp_path: Path) -> None:
    arm = with_effect(ARM, "friction_offset", 1, {})
    records = [replace(r, arm=arm) for r in three("friction_offset", 1, 0.04)]
    assert diagnose(arm, records).verdict == "nothing_missing"


def test_what_one_joint_promises_alone_is_not_in_all_of_them() -> None:
    """A delay of one drive of three, which the mean of all three spreads; and one that all have."""

    def judged(promised: dict[int | None, float]) -> list[int | None]:
        gain = Evidence(50.0, np.array([0.005]), np.ones(3), np.ones(3), 1)
        pairs = [
            (FittedCandidate(Candidate("time_delay", joint), {}, [], gain), Judgement(x, x, ""))
            for joint, x in promised.items()
        ]
        return [
            pair[0].candidate.joint
            for pair in pairs
            if not at_one_joint(pair, pairs, SelectionThresholds().min_whole_arm_share)
        ]

    assert judged({None: 3.2, 1: 0.2, 3: 7.1}) == [1, 3]
    assert judged({None: 7.0, 1: 5.0, 3: 7.1}) == [None, 1, 3]


@pytest.mark.parametrize(("rate", "effect"), [(100.04, None), (99.87, "friction_offset"), (133.3, None)])
def test_periods_that_are_no_whole_rows_measure_the_noise(rate: float, effect: str | None) -> None:
    """Of 1000.4, 998.7 and 1333 samples, the last of which is no multiple of the samples from row to row."""
    records = []
    for r in three(effect, 1, 0.04, 1):
        assert r.input is not None
        t = np.arange(0.0, r.t[-1], 1 / rate)
        q, motor, given = (
            np.stack([np.interp(t, r.t, c) for c in x.T], axis=1) for x in (r.q, r.motor, r.input)
        )
        records.append(replace(r, t=t, q=q, motor=motor, input=given, gain=np.ones_like(q)))
    found = diagnose(ARM, records, experiment=False)
    assert found.lack_of_fit is not None
    assert found.lack_of_fit.statistic < found.lack_of_fit.threshold
    assert [(c.effect, c.joint) for c in found.causes] == ([] if effect is None else [(effect, 1)])
    assert found.verdict == ("nothing_missing" if effect is None else "named")
