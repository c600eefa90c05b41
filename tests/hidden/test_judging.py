"""What counts as found, missed and wrong."""

from typing import Any

import numpy as np
import pytest

from hidden.cases import Label
from hidden.judging import FOUND, MISSED, WRONG, judge
from modelgen.diagnosis.adequacy.lack_of_fit import PART, WHOLE, inflation
from modelgen.diagnosis.adequacy.null_distribution import NULLS
from modelgen.diagnosis.adequacy.smooth_functions import SHAPE, like_delta_bic
from modelgen.diagnosis.options.thresholds import AdequacyThresholds


def label(*hidden: tuple[str, int]) -> Label:
    effects = [{"effect": effect, "joint": joint} for effect, joint in hidden]
    return Label({"hidden": effects}, [1.3] * len(hidden), [1.0] * len(hidden), [0.1, 0.1], [0.1, 0.13])


def answer(*causes: dict[str, Any], verdict: str = "named") -> dict[str, Any]:
    error = {"before": [0.2, 0.26], "after": [0.2, 0.206], "gain_percent": [0, 20], "unit": "A"}
    return {"verdict": verdict, "causes": list(causes), "error": error}


def cause(effect: str, joint: int | None, *also: tuple[str, int], alias: bool = False) -> dict[str, Any]:
    others = [{"effect": name, "joint": place} for name, place in also]
    return {"effect": effect, "joint": joint, "aliases" if alias else "ambiguous_with": others}


def test_a_single_effect() -> None:
    truth = label(("spring", 2))
    found = judge(answer(cause("spring", 2)), truth, [0.2, 0.2])
    assert (found.result, found.in_set, found.size) == (FOUND, True, 1.0)
    # 0.26 holds 0.06 that the effect costs, of which 0.054 are gone.
    assert found.recovered == pytest.approx(0.9)
    assert judge(answer(cause("spring", 1)), truth).result == WRONG
    assert judge(answer(cause("spring", 2), cause("presliding", 1)), truth).result == WRONG
    assert judge(answer(verdict="nothing_missing"), truth).result == MISSED
    assert judge(answer(cause("friction_offset", 2, ("spring", 2), alias=True)), truth).result == FOUND
    ambiguous = judge(answer(cause("friction_offset", 2, ("spring", 2))), truth)
    assert (ambiguous.result, ambiguous.in_set, ambiguous.size) == (WRONG, True, 2.0)


def test_backlash_and_flexibility_are_one_class() -> None:
    found = judge(answer(cause("backlash", 1)), label(("joint_flexibility", 2)))
    assert (found.result, found.by_class) == (WRONG, FOUND)


def test_nulls_and_effects_of_no_catalogue() -> None:
    assert judge(answer(verdict="nothing_missing"), label()).result == FOUND
    assert judge(answer(verdict="cannot_tell"), label()).result == MISSED
    assert judge(answer(cause("spring", 1)), label()).result == WRONG
    spot = label(("hard_spot", 1))
    assert judge(answer(verdict="outside_catalogue"), spot).result == FOUND
    assert judge(answer(cause("spring", 1)), spot).result == WRONG


def test_two_effects() -> None:
    truth = label(("spring", 2), ("base_tilt", 1))
    assert judge(answer(cause("base_tilt", None), cause("spring", 2)), truth).result == FOUND
    half = judge(answer(cause("spring", 2)), truth)
    assert (half.result, half.in_set) == (MISSED, False)


def test_the_null_distribution_lies_beside_the_nominal_threshold() -> None:
    """And shapes have evidence against them in most complete models."""
    assert set(NULLS) == {WHOLE, PART, SHAPE}
    for values in NULLS.values():
        assert len(values) >= 200
        assert list(values) == sorted(values)
    share = AdequacyThresholds().null_share
    assert all(0.5 < inflation(kind, share) < 1.5 for kind in (WHOLE, PART))
    like = like_delta_bic(AdequacyThresholds())
    assert np.median(NULLS[SHAPE]) < 0.0 < like < 20.0
