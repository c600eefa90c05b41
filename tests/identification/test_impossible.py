"""Efforts of the wrong sign are asked about: friction that drives is no result."""

from dataclasses import replace

import numpy as np
import pytest
from diagnosis_support import ARM, three

from modelgen.dataset import choose, prepare
from modelgen.identification.identify import identify
from modelgen.identification.summary import verdict


@pytest.mark.parametrize(
    ("sign", "joints"), [((1.0, 1.0), ""), ((-1.0, -1.0), "j1, j2"), ((1.0, -1.0), "j2")]
)
def test_the_sign_of_the_efforts_is_asked_about(sign: tuple[float, float], joints: str) -> None:
    records = [replace(r, input=np.asarray(r.input) * sign) for r in three(None, 1, 0.0, seed=3)]
    chosen = choose(records)
    *train, test = (prepare(r, chosen) for r in records)
    said = verdict(identify(train, ARM, test=[test]))
    asked = "Is the sign of the efforts the other way round"
    assert (asked in said) == bool(joints)
    if joints:
        assert f"would drive {joints}." in said
