"""Gains and thresholds of the watch: what is generated of an identification, and how often it errs."""

import ctypes
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arms_support import ARMS
from c_support import shared_library

import modelgen as mg
from modelgen.errors import InputError
from modelgen.functions import Options
from modelgen.functions.levels import BETWEEN_FALSE_ALARMS, MARGIN, passage_level

ARM = "ariane4"


NOISE: dict[str, Any] = {
    "input": [0.02, 0.03, 0.02],
    "correlation_s": [0.05, 0.04, 0.02],
    "rest_speed": [0.01, 0.02, 0.03],
    "observer": {"gain": 20.0, "rms": [1.0, 2.0, 1.0], "largest": [3.0, 6.0, 8.0], "duration_s": 60.0},
}


def identification() -> dict[str, Any]:
    nominal = mg.build_model(ARMS[ARM]).nominal
    assert nominal is not None
    parameters = [{"name": k, "value": v, "std": 0.02 * abs(v) or None} for k, v in nominal.items()]
    return {"schema": 1, "arm": ARM, "parameters": parameters, "noise": NOISE}


def observer(**values: Any) -> dict[str, Any]:
    """The identification's noise, the observer's part of it changed."""
    return {"noise": {**NOISE, "observer": {**NOISE["observer"], **values}}}


@pytest.mark.parametrize("z", [1.0, 2.0])
def test_the_level_is_left_when_it_says(z: float) -> None:
    """Mean first passage of low-passed white noise of unit variance, simulated."""
    rng = np.random.default_rng(1)
    bandwidth, step, count = 2.0, 2e-4, 400
    duration = next(t for t in np.geomspace(1e-3, 1e3, 4000) if passage_level(bandwidth, t) > z)
    x, left = np.zeros(count), np.zeros(count)
    inside = np.ones(count, dtype=bool)
    keep, kick = np.exp(-bandwidth * step), np.sqrt(1 - np.exp(-2 * bandwidth * step))
    while inside.sum() > 0.02 * count:
        x[inside] = keep * x[inside] + kick * rng.standard_normal(inside.sum())
        left[inside] += step
        # What crosses between two samples: the bridge of Brownian motion.
        missed = np.exp(-((z - np.abs(x)) ** 2) / (bandwidth * step)) > rng.random(count)
        inside &= ~((np.abs(x) >= z) | missed)
    left[inside] += duration  # without memory
    assert left.mean() == pytest.approx(duration, rel=4 / np.sqrt(count))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("levels")
    (out / "identification.json").write_text(json.dumps(identification()), encoding="utf-8")
    mg.generate(ARMS[ARM], out, Options(derivatives=False), identification=out / "identification.json")
    return out / ARM


def test_gains_and_thresholds_are_those_of_the_noise(folder: Path) -> None:
    library = ctypes.CDLL(str(shared_library(folder, ARM, "double")))
    names = (f"{ARM}_observer_gain", f"{ARM}_observer_threshold")
    gains, thresholds = (np.array((ctypes.c_double * 3).in_dll(library, name)) for name in names)
    bandwidth = 20.0
    np.testing.assert_allclose(gains, bandwidth, rtol=1e-5)
    level, seen = passage_level(bandwidth, 3 * BETWEEN_FALSE_ALARMS), passage_level(bandwidth, 60.0)
    expected = MARGIN * level * np.maximum([1.0, 2.0, 1.0], np.array([3.0, 6.0, 8.0]) / seen)
    np.testing.assert_allclose(thresholds, expected, rtol=1e-3)
    alarms = library.ariane4_observer_alarms
    for scale, bits in (([0.99, -0.99, 0.0], 0), ([1.01, 0.0, -1.01], 5), ([0.0, -1.01, 0.5], 2)):
        assert alarms((ctypes.c_double * 3)(*(thresholds * scale))) == bits


def test_a_changed_parameter_is_an_alarm_beyond_what_is_left_open(folder: Path) -> None:
    library = ctypes.CDLL(str(shared_library(folder, ARM, "double")))
    nominal = mg.build_model(ARMS[ARM]).nominal
    assert nominal is not None
    level = passage_level(1 / 300.0, 3 * BETWEEN_FALSE_ALARMS)
    fc2, dt, deviation = nominal["FC2"], 0.01, 1e-5
    most = level * np.hypot(0.02 * fc2, deviation * np.sqrt(0.05 / dt))  # the longest correlation
    for value, alarm in ((fc2 + 0.99 * most, 0), (fc2 + 1.01 * most, 1), (fc2 - 1.01 * most, 1)):
        state = [value, nominal["FV2"], 0.0, deviation, 1e-8, 1e-3, *([0.0] * 9)]
        found = library.ariane4_monitor_alarms((ctypes.c_double * 15)(*state), (ctypes.c_double * 1)(dt))
        assert found == alarm
    header = (folder / f"include/{ARM}.h").read_text(encoding="utf-8")
    assert "#define ARIANE4_MONITOR_MEMORY 300\n" in header


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"noise": None}, "holds no noise; identify again, with a test record"),
        ({"arm": "ur10e"}, "belongs to the arm 'ur10e', found ariane4; give --arm ur10e"),
        ({"parameters": 3}, "expected what modelgen identify writes as identification.json"),
        ({"noise": {"input": [1.0]}}, "expected what modelgen identify writes, found 'observer' amiss"),
        (observer(gain=-20.0), "expected errors, times, a gain and a duration above zero under `noise`"),
        (observer(gain=1e6), "found a gain of 1e+06 1/s, expected at most 57735 1/s"),
        (observer(rms=[1.0, 2.0]), "found a list of 2 under `noise`, expected 3: one for each joint"),
    ],
)
def test_another_file_is_refused(change: dict[str, Any], message: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        mg.generate(ARMS[ARM], tmp_path / "out", identification={**identification(), **change})
    assert str(caught.value) == f"--identification: {message}"
    assert not (tmp_path / "out").exists()
    with pytest.raises(InputError, match="no such file"):
        mg.generate(ARMS[ARM], tmp_path / "out", identification=tmp_path / "none.json")
