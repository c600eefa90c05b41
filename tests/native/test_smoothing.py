"""Filters and differences in compiled C are those of scipy and of NumPy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import signal

from modelgen import native as compiled
from modelgen.dataset.processing.filters import differences, low_pass
from modelgen.native import both_ways, compiler

pytestmark = pytest.mark.skipif(compiler() is None, reason="no C compiler")
RNG = np.random.default_rng(7)


@pytest.mark.parametrize("order", [1, 2, 3, 4, 5])
@pytest.mark.parametrize("shape", [(30, 1), (400, 6), (400, 8), (401, 19)])
def test_both_ways_is_sosfiltfilt(order: int, shape: tuple[int, int]) -> None:
    table = RNG.normal(size=shape).cumsum(axis=0)
    sos = signal.butter(order, 0.15, output="sos")
    padding = min(len(table) - 1, 25)
    expected = signal.sosfiltfilt(sos, table, axis=0, padlen=padding)
    found = both_ways(table, sos, signal.sosfilt_zi(sos), padding)
    assert found == pytest.approx(expected, abs=1e-12 * np.abs(table).max())


@pytest.mark.parametrize("half", [1, 2, 3])
def test_differences_of_a_polynomial_are_its_derivatives(half: int) -> None:
    t = np.arange(50)[:, None] / 10.0
    powers = np.array([1.0, 2.0]) if half == 1 else np.array([3.0, 4.0])
    d, dd = differences(t**powers, 0.1, half)
    inner = slice(half, 50 - half)
    assert d[inner] == pytest.approx((powers * t ** (powers - 1))[inner], abs=1e-10)
    assert dd[inner] == pytest.approx((powers * (powers - 1) * t ** (powers - 2.0).clip(0))[inner], abs=1e-8)
    assert np.array_equal(d[:half], np.repeat(d[half : half + 1], half, axis=0))


def test_without_a_compiler_the_same_comes_from_scipy_and_numpy(monkeypatch: pytest.MonkeyPatch) -> None:
    table = RNG.normal(size=(500, 4)).cumsum(axis=0)
    smooth = low_pass(table, 40.0, 500.0, 4)
    derivatives = differences(smooth, 2e-3, 3)
    monkeypatch.setattr(compiled, "both_ways", lambda *_: None)
    monkeypatch.setattr(compiled, "central", lambda *_: None)
    assert smooth == pytest.approx(low_pass(table, 40.0, 500.0, 4), abs=1e-12 * np.abs(table).max())
    for a, b in zip(derivatives, differences(smooth, 2e-3, 3), strict=True):
        assert a == pytest.approx(b, abs=1e-12 * np.abs(b).max())
