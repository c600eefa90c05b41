"""A cause that makes nothing less of the error on the test record is a suspect, whatever else it passed."""

from __future__ import annotations

import pytest
from loaded_rod import described, log

import modelgen as mg
from modelgen.description import loads
from modelgen.effects import known_effects


@pytest.mark.parametrize("there", [True, False])
def test_what_the_test_record_does_not_have_is_not_named(there: bool) -> None:
    """A constant effort in the training records, and in the test record or not."""
    arm = loads(described(), "arm.yaml", known_effects())["rod"]
    *train, test = (log(seed, spring=False, reach=0.8, loaded=0.0) for seed in range(3))
    for table in (*train, *([test] if there else [])):
        table["i1"] = table["i1"] + 0.02
    found = mg.diagnose(arm, train, test, effects=["friction_offset"], experiment=False, processes=1)
    if there:
        assert (found.verdict, [c.effect for c in found.causes]) == ("named", ["friction_offset"])
        return
    assert (found.verdict, found.causes) == ("suspected", ())
    (suspect,) = found.to_json()["suspects"]
    assert suspect["effect"] == "friction_offset"
    failed = [c["name"] for c in suspect["checks"] if c["decides"] and c["passed"] is False]
    assert failed == ["confirmed"]
    # What is written is the arm without it.
    assert found.extended_arm.joints[0].effects == arm.joints[0].effects
