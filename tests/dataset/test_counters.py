"""Efforts of a counter that overflows are refused; those that are cut off, switched or spoilt are not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from dataset_support import AXIS, DRIVEN, columns, times, write_csv

import modelgen as mg
from modelgen.dataset import Stream
from modelgen.errors import InputError

T = times(20.0, 200.0)
Table = dict[str, np.ndarray]


def counted(effort: np.ndarray, bits: int, scale: float) -> np.ndarray:
    """Counts of so many bits, `scale` of them in a unit of the effort, as two's complement has them."""
    whole = np.rint(effort * scale).astype(np.int64)
    half = 1 << (bits - 1)
    return ((whole + half) % (2 * half) - half).astype(float)


def current(seed: int, size: float = 1.0) -> np.ndarray:
    random = np.random.default_rng(seed)
    return size * (1.3 * np.sin(2 * T) + 0.8 * np.sin(5.3 * T + 1)) + 0.01 * random.normal(size=len(T))


@pytest.mark.parametrize(
    ("bits", "scale", "unit"),
    [(16, 20000.0, 1.0), (16, 25000.0, 1 / 25000), (12, 1400.0, 1 / 1400), (8, 80.0, 1.0)],
)
def test_a_counter_that_overflows_is_refused(bits: int, scale: float, unit: float, tmp_path: Path) -> None:
    table = columns(T) | {"i2": unit * counted(current(1), bits, scale)}
    first = int(np.argmax(np.abs(np.diff(table["i2"])) > 1.8 * unit * (1 << (bits - 1))))
    with pytest.raises(
        InputError, match=f"column i2 goes from .* a counter of {bits} bits overflows"
    ) as told:
        mg.read_log(table, DRIVEN)
    assert f"after t = {T[first]:.9g} s" in str(told.value)
    decimals = {name: np.round(x, 7) for name, x in table.items()}
    for log in (decimals, write_csv(tmp_path / "a.csv", decimals)):
        with pytest.raises(InputError, match=f"a counter of {bits} bits overflows"):
            mg.identify(DRIVEN, log, columns(T))
    with pytest.raises(InputError, match=f"a counter of {bits} bits overflows"):
        list(Stream(str(tmp_path / "a.csv"), DRIVEN).records())


def test_a_foreign_log_is_refused_as_it_was_logged(tmp_path: Path) -> None:
    mapping = tmp_path / "m.yaml"
    mapping.write_text(
        "schema: 1\ntime: {column: t, unit: s}\njoints:\n"
        "  - position: {column: q, unit: mm}\n    effort: {column: raw, unit: N, scale: 0.013, offset: 4}\n"
    )
    log = {"t": T, "q": 100 * np.sin(2 * T), "raw": counted(current(2), 16, 18000.0)}
    file = write_csv(tmp_path / "a.csv", log)
    with pytest.raises(InputError, match=r"column tau1 .* a counter of 16 bits overflows"):
        mg.read_log(file, AXIS, mapping=mapping)


@pytest.mark.parametrize("seed", range(3))
def test_what_else_efforts_do_is_no_overflow(seed: int) -> None:
    random = np.random.default_rng(seed)
    fine = counted(current(seed, 0.7), 16, 20000.0) / 20000.0
    switched = 32767.0 * np.sign(np.sin(7 * T)) + np.rint(3 * random.normal(size=len(T)))
    spoilt = fine.copy()
    spoilt[int(random.integers(100, 3900))] -= 65536 / 20000.0
    cases = {
        "within": fine,
        "cut off": np.clip(np.rint(current(seed) * 20000.0), -32768, 32767) / 20000.0,
        "switched": np.clip(switched, -32768, 32767),
        "pulsed": np.rint(32767 * np.sign(np.sin(7 * T)) * random.uniform(0.9, 1.0, len(T))),
        "spoilt": spoilt,
        "noise": np.rint(32767 * random.uniform(-1, 1, len(T))),
        "steps": np.rint(127 * np.sin(3 * T)),
    }
    for what, effort in cases.items():
        assert np.ptp(mg.read_log(columns(T) | {"i2": effort}, DRIVEN).input) > 0, what
