"""Columns that C computes, filters and decimates are those of NumPy and scipy."""

from __future__ import annotations

import numpy as np
import pytest
from arms_support import ARMS, EVERY_ARM, model

from modelgen.backends.compiled import RegressorColumns
from modelgen.backends.numpy import NumpyFunction
from modelgen.dataset.processing.decimation import decimation
from modelgen.dataset.processing.filters import low_pass
from modelgen.functions import Function
from modelgen.native import plain_columns
from modelgen.native.columns import LARGEST, Columns
from modelgen.native.lanes import plain_text

RATE = 1000.0


def regressor(name: str) -> Function:
    (function,) = [f for f in model(name, "default").functions if f.name == "regressor"]
    return function


def motion(name: str, samples: int) -> dict[str, np.ndarray]:
    """Smooth random motion about the middle of the joints' ranges."""
    rng = np.random.default_rng(5)
    arm = ARMS[name]
    t = np.arange(samples)[:, None] / RATE
    limits = [arm.joints[i].limits.position or (-1.0, 1.0) for i in arm.coordinates]
    low, high = np.array(limits).T
    w = 2 * np.pi * rng.uniform(0.2, 4.0, len(low))
    size = 0.4 * np.minimum(high - low, 6.0)
    phase = rng.uniform(0, 6, len(low))
    return {
        "q": (low + high) / 2 + size * np.sin(w * t + phase),
        "dq": w * size * np.cos(w * t + phase),
        "ddq": -w * w * size * np.sin(w * t + phase),
    }


@pytest.mark.parametrize("name", EVERY_ARM)
def test_every_arm(name: str) -> None:
    function, samples = regressor(name), 1203
    given = motion(name, samples)
    columns = RegressorColumns(function)
    rows = np.arange(150, samples - 150, 11)
    d = decimation(samples, rows, 36.0, RATE, 4)
    assert d is not None
    found = columns.filtered(list(given.values()), **vars(d))
    full = np.asarray(NumpyFunction(function)(**given)).reshape(samples, -1)
    expected = low_pass(full, 36.0, RATE, 4)[rows]
    assert columns.values(list(given.values())) == pytest.approx(
        full[:, columns.elements], abs=1e-13 * np.abs(full).max()
    )
    size = np.max(np.abs(expected))
    assert np.max(np.abs(found - expected[:, columns.elements])) < 1e-10 * size
    assert not np.delete(full, columns.elements, axis=1).any()
    assert np.max(np.abs(found)) > 0.0


@pytest.mark.parametrize(
    ("samples", "first", "factor", "steps", "order"),
    [
        (300, 40, 4, 50, 1),
        (700, 100, 5, 1, 2),
        (700, 100, 17, 7, 3),
        (900, 0, 16, 8, 4),
        (900, 99, 40, 15, 5),
    ],
)
def test_shapes_of_the_work(samples: int, first: int, factor: int, steps: int, order: int) -> None:
    """Lanes with and without something to do, tiles full and begun, any order of the filter."""
    function = regressor("yaw3pitch")
    given = motion("yaw3pitch", samples)
    rows = first + factor * np.arange(steps + 1)
    d = decimation(samples, rows, 60.0, RATE, order)
    assert d is not None
    found = RegressorColumns(function).filtered(list(given.values()), **vars(d))
    full = np.asarray(NumpyFunction(function)(**given)).reshape(samples, -1)
    columns = RegressorColumns(function)
    assert found == pytest.approx(d(full[:, columns.elements]), abs=1e-11 * np.abs(full).max())


def test_samples_may_have_weights_by_row() -> None:
    function = regressor("yaw3pitch")
    given = motion("yaw3pitch", 700)
    d = decimation(700, np.arange(100, 600, 17), 60.0, RATE, 3)
    assert d is not None
    columns, n = RegressorColumns(function, weighted=True), given["q"].shape[1]
    weights = np.random.default_rng(3).uniform(size=(700, n))
    full = np.asarray(NumpyFunction(function)(**given)).reshape(700, n, -1) * weights[:, :, None]
    found = columns.filtered([*given.values(), weights], **vars(d))
    wanted = d(full.reshape(700, -1)[:, columns.elements])
    assert found == pytest.approx(wanted, abs=1e-11 * np.abs(full).max())


def test_sine_and_cosine_are_as_exact_as_is_stated() -> None:
    """To 2.1e-16 up to the largest angle, near multiples of pi/4 too, against extended precision."""
    if np.finfo(np.longdouble).eps > 1e-18:
        pytest.skip("long double is no more than double here")
    text = plain_text(1).replace("COLUMNS = 1", "COLUMNS = 2")
    begin = text.index("    for (int i = 0; i < COLUMNS")
    columns = Columns(f"{text[:begin]}    out[0] = m_sin(x[0]);\n    out[1] = m_cos(x[0]);\n}}\n", 2)
    quarters = np.arange(int(LARGEST * 4 / np.pi)) * np.pi / 4
    near = (quarters[:, None] + np.arange(-3, 4) * np.spacing(quarters)[:, None]).ravel()
    x = np.concatenate([np.random.default_rng(4).uniform(-LARGEST, LARGEST, 500_000), near, -near])
    found = columns.values([x[:, None]])
    exact = x.astype(np.longdouble)
    errors = np.maximum(np.abs(found[:, 0] - np.sin(exact)), np.abs(found[:, 1] - np.cos(exact)))
    assert 1e-17 < errors.max() <= 2.1e-16


def test_plain_columns_are_those_of_numpy() -> None:
    rng = np.random.default_rng(1)
    table = rng.normal(size=(3000, 5)).cumsum(axis=0)
    d = decimation(3000, np.arange(200, 2800, 13), 30.0, RATE, 4)
    assert d is not None
    found = plain_columns(5).filtered([table], **vars(d))
    assert found == pytest.approx(d._filtered(table), abs=1e-12 * np.abs(table).max())


def test_a_column_is_the_same_whichever_are_filtered_with_it() -> None:
    rng = np.random.default_rng(2)
    table = rng.normal(size=(3000, 11)).cumsum(axis=0)
    d = decimation(3000, np.arange(200, 2800, 13), 30.0, RATE, 4)
    assert d is not None
    together = d(table)
    for count in range(1, 11):
        assert np.array_equal(d(table[:, :count]), together[:, :count])
