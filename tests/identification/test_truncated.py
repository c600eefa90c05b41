"""Currents in steps that were cut off towards zero, as by a cast to whole numbers, are asked about."""

from __future__ import annotations

import re

import numpy as np
import pytest
from geared_link import LINK, sines

import modelgen as mg
from modelgen.description import loads

ARM = loads(LINK.description())["one"]
LEVEL, HANGING = 0.0, -np.pi / 2  # rad; about the level all but none of the currents are below zero


def log(seed: int, centre: float, noise: float = 0.02) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Two periods at 200 Hz: times [s], angles [rad], currents [A]."""
    random = np.random.default_rng([21, seed])
    t = np.arange(0.0, 16.0, 0.005)
    q, dq, ddq = sines(t, random.uniform(0.0, 2 * np.pi, 4))
    return t, centre + q, LINK.currents(centre + q, dq, ddq) + noise * random.normal(size=len(t))


def asked(currents: list[np.ndarray], logs: list[tuple[np.ndarray, ...]], formula: str = "i1") -> list[str]:
    """Questions about efforts that are too small."""
    tables = [{"t": t, "q1": q, "i1": i} for (t, q, _), i in zip(logs, currents, strict=True)]
    for table in tables:
        if formula != "i1":
            half = float(formula.split("+")[1].split("*", maxsplit=1)[0])
            table["i1"] = table["i1"] + half * np.sign(table["i1"])
    doubts = mg.identify(ARM, tables[:2], tables[2]).to_json()["doubts"]
    return [x for x in doubts if "are smaller than the model's" in x]


@pytest.mark.parametrize("step", [0.02, 0.05, 0.1])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_currents_cut_towards_zero_are_asked_about(seed: int, step: float) -> None:
    """What the question proposes ends it."""
    logs = [log(3 * seed + k, HANGING) for k in range(3)]
    cut = [step * np.trunc(i / step) for _, _, i in logs]
    (said,) = asked(cut, logs)
    assert said.startswith("The efforts of hip are smaller than the model's, of either sign, by ")
    share = re.search(r"by ([\d.]+) ± ([\d.e-]+) of their step of ([\d.]+) A", said)
    assert share is not None
    assert float(share[1]) == pytest.approx(0.5, abs=0.1)
    assert float(share[3]) == pytest.approx(step)
    formula = re.search(r"\{column: (.*)\}", said)
    assert formula is not None
    assert asked(cut, logs, formula[1]) == []


@pytest.mark.parametrize("step", [0.01, 0.02, 0.05, 0.1, 0.25])
@pytest.mark.parametrize("centre", [LEVEL, HANGING])
@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_currents_that_are_rounded_are_not(noise: float, centre: float, step: float) -> None:
    logs = [log(30 + k, centre, noise) for k in range(3)]
    assert asked([step * np.rint(i / step) for _, _, i in logs], logs) == []


def test_currents_of_one_sign_cannot_be_asked() -> None:
    """Half a step is a constant there, as a zero that is off."""
    logs = [log(40 + k, LEVEL) for k in range(3)]
    one_sign = [i - min(x.min() for _, _, x in logs) + 0.1 for _, _, i in logs]
    assert asked([0.05 * np.trunc(i / 0.05) for i in one_sign], logs) == []
