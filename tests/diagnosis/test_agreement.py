"""Records agree on a cause's size where it is the same in all, up to what coloured noise scatters."""

from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from diagnosis_support import equations_of
from numpy.random import default_rng
from scipy.signal import lfilter

from modelgen.diagnosis.equations.rows import Rows
from modelgen.diagnosis.validation.agreement import agreement

PERIOD, PERIODS = 250, 3
TIME = np.arange(PERIOD * PERIODS) / PERIOD  # in periods


def judged(seed: int, sizes: tuple[float, ...], *, unlike: bool = False) -> float:
    """Of records of one joint that rests a quarter of the time: a rigid model of three columns, and a cause
    of these sizes. unlike: the records after the first lack the cause's column.
    """
    random = default_rng(seed)
    rows, columns = [], []
    for k, size in enumerate(sizes):
        phase = 1.0 + k
        base = np.stack([np.ones_like(TIME), np.sin(2 * np.pi * TIME + phase), np.cos(6 * np.pi * TIME)])
        cause = np.abs(np.sin(2 * np.pi * TIME + phase)) * np.sign(np.cos(4 * np.pi * TIME))
        noise = lfilter([1.0], [1.0, -0.9], random.normal(size=len(TIME) + 200))[200:]
        effort = np.array([3.0, 2.0, -1.0]) @ base + size * cause + noise
        moving = np.ones((len(TIME), 1), dtype=bool)
        moving[(np.arange(len(TIME)) % PERIOD) < PERIOD // 4] = False
        rows.append(cast(Rows, SimpleNamespace(effort=effort[:, None], moving=moving)))
        shown = 0.0 * cause if unlike and k else cause
        columns.append(np.stack([*base, shown], axis=1)[:, None, :])
    parts = [([row], [k]) for k, row in enumerate(rows)]
    return agreement(parts, equations_of(rows, [PERIOD] * len(rows)), columns, 3).probability


@pytest.mark.parametrize("count", [2, 3])
def test_equal_sizes_agree_as_often_as_they_should(count: int) -> None:
    """Of 200 a twentieth seems unequal at 5 %: noise at the period's harmonics is not overlooked."""
    found = np.array([judged(seed, (1.0,) * count) for seed in range(200)])
    assert 2 <= (found < 0.05).sum() <= 22
    assert found.min() > 1e-5
    assert 0.35 < np.median(found) < 0.65


def test_what_the_records_contradict_is_seen() -> None:
    assert max(judged(seed, (4.0, -4.0)) for seed in range(20)) < 1e-4


def test_what_one_record_lacks_is_not_agreed_on() -> None:
    assert judged(0, (4.0, 4.0), unlike=True) == 0.0
