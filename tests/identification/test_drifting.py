"""Currents that drift over a record are asked about: parameters are means over it, or take up a part."""

from __future__ import annotations

import re

import numpy as np
import pytest
from geared_link import LINK, sines
from made_up_plants import CONSTANT, PERIOD, PLAIN, WAVES, description, motion

import modelgen as mg
from modelgen.description import loads

ONE = loads(LINK.description(values=False))["one"]
TWO = loads(description(2))["made_up"]
Table = dict[str, np.ndarray]


def of_link(seed: int, drift: float = 0.0, warmer: float = 0.0, weaker: float = 0.0) -> Table:
    """Two periods of the link at 200 Hz. Over the record, drift: of its current's zero; warmer: of its dry
    friction [A]; weaker: of its torque, which more current makes up for.
    """
    random = np.random.default_rng([31, seed])
    t = np.arange(0.0, 16.0, 0.005)
    q, dq, ddq = sines(t, random.uniform(0.0, 2 * np.pi, 4))
    over, noise = t / t[-1], 0.02 * random.normal(size=len(t))
    current = LINK.currents(q, dq, ddq) / (1.0 - weaker * over) + (drift + warmer * np.sign(dq)) * over
    return {"t": t, "q1": q, "i1": current + noise}


def of_arm(seed: int, drift: float = 0.0) -> Table:
    """Five periods of the planar arm with dry friction at 250 Hz. drift: at its second joint [A]."""
    random = np.random.default_rng([32, seed])
    t = np.arange(0.0, 5 * PERIOD, 0.004)
    q, dq, ddq = motion(t, random.uniform(0.0, 2 * np.pi, (2, len(WAVES))))
    current = PLAIN[2].currents(q, dq, ddq) + np.sign(dq) * np.divide((0.018, 0.011), CONSTANT)
    current[:, 1] += drift * t / t[-1]
    current += 0.01 * random.normal(size=q.shape)
    return {"t": t, "q1": q[:, 0], "q2": q[:, 1], "i1": current[:, 0], "i2": current[:, 1]}


def asked(arm: mg.Arm, logs: list[Table], about: str = "drift away from the model's") -> list[str]:
    """Questions about a drift."""
    doubts = mg.identify(arm, logs[:2], logs[2]).to_json()["doubts"]
    return [x for x in doubts if about in x]


@pytest.mark.parametrize("signs", [(1, 1), (1, -1), (0, 1)])
def test_a_drift_is_asked_about_with_its_size_in_each_record(signs: tuple[int, int]) -> None:
    (said,) = asked(ONE, [*(of_link(k, 0.2 * sign) for k, sign in enumerate(signs)), of_link(2)])
    assert said.startswith("The efforts of hip drift away from the model's, by ")
    shown = re.findall(r"(-?[\d.]+) ± ([\d.e-]+) A in 16 s of (\S+?)[,:] ", said)
    expected = {f"train[{k}]": 0.2 * sign for k, sign in enumerate(signs) if sign}
    assert {name for _, _, name in shown} == expected.keys()
    for size, std, name in shown:
        assert abs(float(size) - expected[name]) < 4 * float(std)


@pytest.mark.parametrize("warmer", [(-0.1, -0.1), (0.0, -0.1), (0.15, 0.15)])
def test_friction_that_changes_is_asked_about_and_is_no_drift_of_a_zero(warmer: tuple[float, float]) -> None:
    """The mean over the record is what identification gives."""
    logs = [*(of_link(k, 0.0, x) for k, x in enumerate(warmer)), of_link(2)]
    (said,) = asked(ONE, logs, "Friction at hip changes, by ")
    shown = re.findall(r"(-?[\d.]+) ± ([\d.e-]+) A in 16 s of (\S+?)[,:] ", said)
    expected = {f"train[{k}]": x for k, x in enumerate(warmer) if x}
    assert {name for _, _, name in shown} == expected.keys()
    for size, std, name in shown:
        assert abs(float(size) - expected[name]) < 4 * float(std)
    assert asked(ONE, logs) == []


@pytest.mark.parametrize("weaker", [(0.1, 0.1), (0.0, 0.1)])
def test_a_motor_that_loses_torque_is_asked_about(weaker: tuple[float, float]) -> None:
    """As its magnets warm: more current for the same torque."""
    logs = [*(of_link(k, weaker=x) for k, x in enumerate(weaker)), of_link(2)]
    (said,) = asked(ONE, logs, "grow or shrink against the model's, by ")
    shown = re.findall(r"(-?[\d.]+) ± ([\d.e-]+) % in 16 s of (\S+?)[,:] ", said)
    expected = {f"train[{k}]": 100.0 * x for k, x in enumerate(weaker) if x}
    assert {name for _, _, name in shown} == expected.keys()
    for size, _, name in shown:
        assert float(size) == pytest.approx(expected[name], rel=0.25)
    assert asked(ONE, logs) == asked(ONE, logs, "Friction at hip changes") == []


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_drift_at_one_joint_of_two_is_asked_about_there(seed: int) -> None:
    (said,) = asked(TWO, [of_arm(3 * seed + k, 0.15) for k in range(3)])
    assert said.startswith("The efforts of j2 drift away")


@pytest.mark.parametrize("seed", range(20))
def test_a_sound_log_of_a_link_raises_no_question(seed: int) -> None:
    logs = [of_link(100 + 3 * seed + k) for k in range(3)]
    assert mg.identify(ONE, logs[:2], logs[2]).to_json()["doubts"] == []


@pytest.mark.parametrize("seed", range(5))
def test_a_sound_log_of_an_arm_raises_no_question(seed: int) -> None:
    logs = [of_arm(100 + 3 * seed + k) for k in range(3)]
    assert mg.identify(TWO, logs[:2], logs[2]).to_json()["doubts"] == []
