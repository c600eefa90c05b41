"""The filter at the kept samples alone is the filter of all samples."""

from __future__ import annotations

import numpy as np
import pytest

from modelgen.dataset.processing.decimation import decimation, kept
from modelgen.dataset.processing.filters import low_pass, reach

RATE = 1000.0


def drifting(samples: int) -> np.ndarray:
    """Columns with a trend, noise and a step: their ends are not zero."""
    rng = np.random.default_rng(2)
    table = np.cumsum(rng.normal(size=(samples, 3)), axis=0) + 5.0 * rng.normal(size=(samples, 3))
    table[samples // 3 :, 1] += 100.0
    return table


@pytest.mark.parametrize("order", [1, 2, 3, 4, 5])
@pytest.mark.parametrize(
    ("samples", "first", "factor", "cutoff"), [(4000, 44, 11, 36.0), (20_000, 3000, 86, 5.0)]
)
def test_it_is_scipy_s_filter(order: int, samples: int, first: int, factor: int, cutoff: float) -> None:
    table = drifting(samples)
    rows = np.arange(first, samples - first, factor)
    made = decimation(samples, rows, cutoff, RATE, order)
    assert made is not None
    expected = low_pass(table, cutoff, RATE, order)[rows]
    size = np.max(np.abs(expected), axis=0)
    # Both have forgotten the end of the padding to 1e-6, and that once more over the padding itself.
    assert np.max(np.abs(made(table) - expected) / size) < 2e-9
    far = slice(len(rows) // 3, 2 * len(rows) // 3)
    assert np.max(np.abs(made(table) - expected)[far] / size) < 1e-12


def test_a_constant_and_a_slow_wave_pass() -> None:
    t = np.arange(5000) / RATE
    rows = np.arange(500, 4500, 20)
    wave = np.sin(2 * np.pi * 2.0 * t)
    found = kept(np.column_stack([np.full(len(t), 3.0), wave]), rows, 20.0, RATE, 4)
    assert found[:, 0] == pytest.approx(3.0, rel=1e-12)
    assert found[:, 1] == pytest.approx(
        wave[rows] / (1 + np.tan(np.pi * 2 / 1e3) ** 8 / np.tan(np.pi * 20 / 1e3) ** 8), abs=1e-9
    )


def test_what_is_not_finite_leaves_the_other_columns_alone() -> None:
    table = drifting(4000)
    rows = np.arange(400, 3600, 20)
    expected = kept(table, rows, 20.0, RATE, 4)
    table[2000, 1] = np.inf
    found = kept(table, rows, 20.0, RATE, 4)
    assert not np.isfinite(found[:, 1]).any()
    assert np.array_equal(found[:, [0, 2]], expected[:, [0, 2]])


def test_short_records_and_little_decimation_are_filtered_as_a_whole() -> None:
    table = drifting(200)
    rows = np.arange(20, 180, 20)
    assert reach(5.0, RATE, 4, 1e-6) > 200
    assert decimation(200, rows, 5.0, RATE, 4) is None
    assert np.array_equal(kept(table, rows, 5.0, RATE, 4), low_pass(table, 5.0, RATE, 4)[rows])
    assert decimation(200, np.arange(20, 180, 2), 100.0, RATE, 4) is None
    assert np.array_equal(kept(table, rows, 0.0, RATE, 4), table[rows])
