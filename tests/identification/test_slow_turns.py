"""Efforts that were smoothed before they were logged are asked about, where friction is wrong for it."""

from __future__ import annotations

from collections.abc import Callable

import made_up_plants as plants
import numpy as np
import pytest
from scipy import signal

import modelgen as mg
from modelgen.description import loads
from modelgen.effects import known_effects

RATE, SECONDS = 500.0, 16.0
FRICTION = (0.35, 0.22)  # A
Filter = Callable[[np.ndarray], np.ndarray]
Table = dict[str, np.ndarray]


@pytest.fixture(scope="module")
def arm() -> mg.Arm:
    """The planar arm, with dry friction at both joints."""
    text = plants.description(2, "{coulomb_friction: {magnitude: 0.011}}")
    first = f"{{drive_inertia: {{inertia: {plants.ROTOR[0]}}}}}"
    text = text.replace(first, first + ", {coulomb_friction: {magnitude: 0.021}}")
    return loads(text, "arms.yaml", known_effects())["made_up"]


def log(seed: int, noise: float = 0.01, soft: float = 0.0) -> Table:
    """A log of the arm by Lagrange's equations, efforts at the positions' instants. soft: speed [rad/s] over
    which the elbow's friction turns round; 0: at once.
    """
    random = np.random.default_rng(seed)
    t = np.arange(int(RATE * SECONDS)) / RATE
    q, dq, ddq = plants.motion(t, random.uniform(0, 6.28, (2, len(plants.WAVES))))
    sign = np.sign(dq)
    if soft:
        sign[:, 1] = np.tanh(dq[:, 1] / soft)
    current = plants.PLAIN[2].currents(q, dq, ddq) + FRICTION * sign
    current = current + noise * random.normal(size=q.shape)
    motor = np.rint(q * plants.RATIO / 1e-3) * 1e-3
    return {"t": t, "qm1": motor[:, 0], "qm2": motor[:, 1], "i1": current[:, 0], "i2": current[:, 1]}


def smoothed(table: Table, by: Filter, names: tuple[str, ...]) -> Table:
    return {name: by(x) if name in names else x for name, x in table.items()}


def butterworth(cutoff: float) -> Filter:
    sections = signal.butter(2, cutoff, fs=RATE, output="sos")
    return lambda x: np.asarray(signal.sosfiltfilt(sections, x))


def mean(samples: int) -> Filter:
    return lambda x: np.convolve(np.pad(x, samples // 2, mode="edge"), np.ones(samples) / samples, "valid")


def polynomials(samples: int) -> Filter:
    return lambda x: np.asarray(signal.savgol_filter(x, samples, 3))


def questions(found: mg.Identification) -> list[str]:
    return [x for x in found.to_json()["doubts"] if "change as slowly at its turns" in x]


EFFORTS, ALL = ("i1", "i2"), ("qm1", "qm2", "i1", "i2")


@pytest.mark.parametrize(
    ("by", "names"),
    [
        (butterworth(3.0), EFFORTS),
        (butterworth(6.0), ALL),
        (mean(51), EFFORTS),
        (mean(101), ALL),
        (mean(75), ("i2",)),
        (polynomials(151), ALL),
    ],
)
def test_smoothed_efforts_are_asked_about(by: Filter, names: tuple[str, ...], arm: mg.Arm) -> None:
    train, test = (smoothed(log(seed), by, names) for seed in (1, 2))
    found = mg.identify(arm, train, test)
    plain = mg.identify(arm, log(1), log(2))
    off = {
        name: abs(e.value - plain.parameters[name].value) / e.std
        for name, e in found.parameters.items()
        if e.std is not None
    }
    assert max(off.values()) > 3.0  # without a word it would be silent
    asked = questions(found)
    assert asked
    joints = ["j2"] if names == ("i2",) else ["j1", "j2"]
    assert all(any(f"efforts of {name} " in x for name in joints) for x in asked)


def test_it_says_what_friction_would_be(arm: mg.Arm) -> None:
    train, test = (smoothed(log(seed), mean(101), EFFORTS) for seed in (3, 4))
    found = mg.identify(arm, train, test)
    truth = 0.0
    for x in questions(found):
        said = x.split("so read, ")[1].split(":")[0].replace("is ", "").replace("not ", "")
        name, right, wrong = said.replace(",", "").split()
        truth = mg.identify(arm, log(3), log(4)).parameters[name].value
        assert abs(float(right) - truth) < 0.4 * abs(float(wrong) - truth)
    assert truth


def test_a_diagnosis_says_so_too(arm: mg.Arm) -> None:
    train, test = (smoothed(log(seed), mean(101), EFFORTS) for seed in (3, 4))
    found = mg.diagnose(arm, train, test, experiment=False, effects=["friction_offset"])
    assert any("change as slowly at its turns" in x for x in found.to_json()["doubts"])


@pytest.mark.parametrize("noise", [0.0, 1e-3, 0.01, 0.05])
@pytest.mark.parametrize("seed", [1, 5, 7])
def test_readings_as_they_are_raise_no_question(noise: float, seed: int, arm: mg.Arm) -> None:
    assert not questions(mg.identify(arm, log(seed, noise), log(seed + 50, noise)))


def test_a_filter_above_the_band_raises_none(arm: mg.Arm) -> None:
    train, test = (smoothed(log(seed), butterworth(60.0), EFFORTS) for seed in (1, 2))
    assert not questions(mg.identify(arm, train, test))


@pytest.mark.parametrize("soft", [0.1, 0.3, 1.0])
def test_friction_that_grows_with_the_speed_is_no_smoothing(soft: float, arm: mg.Arm) -> None:
    assert not questions(mg.identify(arm, log(1, 1e-3, soft=soft), log(2, 1e-3, soft=soft)))
