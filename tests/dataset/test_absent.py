"""Efforts that dropped out, froze or have a dead band are no readings; those that stand rightly are."""

from __future__ import annotations

import numpy as np
import pytest
from geared_link import LINK, sines

import modelgen as mg
from modelgen.dataset.reading.absent import absent
from modelgen.description import loads
from modelgen.effects import known_effects

ARM = loads(LINK.description(), "arms.yaml", known_effects())["one"]
T = np.arange(0.0, 24.0, 0.004)
KINDS = ("dropped out", "a number for nothing", "frozen", "dead band")


def log(seed: int, kind: str, noise: float = 0.005) -> dict[str, np.ndarray]:
    """Three periods of four harmonics about the upright, by hand, whose current is partly not read."""
    random = np.random.default_rng(seed)
    q, dq, ddq = sines(T, random.uniform(0, 6.28, 4))
    q += np.pi / 2
    current = LINK.currents(q, dq, ddq) + noise * random.standard_normal(len(T))
    places = random.integers(200, len(T) - 200, 12)
    for place in places:
        if kind == "dropped out":
            current[place : place + 10] = 0.0
        elif kind == "a number for nothing":
            current[place : place + 10] = -32.768
        elif kind == "frozen":
            current[place : place + 40] = current[place]
    if kind == "dead band":
        current[np.abs(current) < 0.3] = 0.0
    return {"t": T, "q1": q + 2e-6 * random.standard_normal(len(T)), "i1": current}


@pytest.mark.parametrize("kind", KINDS)
def test_what_was_not_read_moves_no_parameter(kind: str) -> None:
    found = mg.identify(ARM, log(1, kind), log(2, kind))
    for name, value in LINK.parameters.items():
        p = found.parameters[name]
        assert abs(p.value - value) < 4.0 * p.std, name
        assert p.std < 0.03 * max(value, 0.02 * LINK.moment), name
    (remark,) = (x for x in mg.read_log(log(1, kind), ARM).remarks if "it was not read" in x)
    assert "i1 stands at" in remark


@pytest.mark.parametrize("kind", KINDS)
def test_what_was_not_read_is_no_cause(kind: str) -> None:
    found = mg.diagnose(ARM, train=[log(1, kind), log(2, kind)], test=log(3, kind))
    assert found.verdict == "nothing_missing", found


@pytest.mark.parametrize("noise", [0.0, 0.005])
@pytest.mark.parametrize("step", [0.0, 0.002, 0.02, 0.2])
def test_readings_are_readings(step: float, noise: float) -> None:
    """Of whatever steps, also where they are cut off; simulated ones may stand."""
    current = log(1, "", noise)["i1"]
    highest = float(np.quantile(current, 0.9))
    cut = np.minimum(current, highest)
    stands = np.concatenate([current[:2000], np.full(600, current[1999]), current[2000:]])
    for values in (current, cut) if noise else (current, cut, stands):
        read = values if not step else step * np.rint(values / step)
        assert not absent(read, np.cumsum(np.ones(len(read)))).any()


def test_an_effort_that_is_commanded_in_steps_is_read() -> None:
    levels = np.random.default_rng(1).uniform(-1.0, 1.0, 60)
    assert not absent(np.repeat(levels, 100), T).any()
    trapezoid = np.interp(T % 8.0, [0.0, 2.0, 4.0, 6.0, 8.0], [0.0, 1.0, 1.0, -1.0, 0.0])
    assert not absent(trapezoid, T).any()
