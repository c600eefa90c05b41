"""A reading that those beside it rule out is taken as they say, with a remark; noise and steps stay."""

from __future__ import annotations

import numpy as np
import pytest
from dataset_support import DRIVEN, columns, times

import modelgen as mg

T = times(10.0, 200.0)


ENDS = [0, 1, len(T) - 2, len(T) - 1]


@pytest.mark.parametrize(
    ("name", "by", "place"),
    [
        *((name, by, k) for name, by in (("q1", 0.4), ("qm2", -500.0), ("i1", 6.0)) for k in (2, 700, 1997)),
        *((name, by, k) for name, by in (("q1", 0.4), ("qm2", -500.0)) for k in ENDS),
    ],
)
def test_a_wrong_digit_is_mended_and_said(name: str, by: float, place: int) -> None:
    right = columns(T)
    wrong = right | {name: right[name] + by * (np.arange(len(T)) == place)}
    found, whole = mg.read_log(wrong, DRIVEN), mg.read_log(right, DRIVEN)
    assert found.q == pytest.approx(whole.q, abs=1e-6)
    assert found.input == pytest.approx(whole.input, abs=1e-2)
    (remark,) = set(found.remarks) - set(whole.remarks)
    assert f"{name} has a reading that those beside it rule out: {wrong[name][place]:.9g}" in remark
    assert f"in sample {place + 1};" in remark


def test_an_effort_may_begin_with_a_step() -> None:
    right = columns(T)
    table = right | {"i1": right["i1"] + 6.0 * (np.arange(len(T)) == 0)}
    assert not any("rule out" in remark for remark in mg.read_log(table, DRIVEN).remarks)


@pytest.mark.parametrize("seed", range(5))
def test_what_a_log_may_have_stays(seed: int) -> None:
    random, right = np.random.default_rng(seed), columns(T)
    count = 2 * np.pi / 4096
    table = right | {
        "q1": count * np.rint(right["q1"] / count),  # steps of an encoder
        "qm2": right["qm2"] + 0.5 * random.standard_t(4, len(T)),  # noise with heavy tails
        "i1": np.sign(np.sin(3 * T)) + 0.01 * random.normal(size=len(T)),  # switched
        "i2": right["i2"] + 0.5 * (random.uniform(size=len(T)) < 0.05),  # often off
    }
    assert not any("rule out" in remark for remark in mg.read_log(table, DRIVEN).remarks)
