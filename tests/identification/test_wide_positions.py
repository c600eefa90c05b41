"""Positions of motors and positions in degrees, of all joints or of one: the question names which."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from made_up_plants import CONSTANT, PERIOD, PLAIN, RATIO, WAVES, description, motion

import modelgen as mg
from modelgen.description import loads

ARM = loads(description(2))["made_up"]
COUNTS = 4096  # per turn of a motor
Table = dict[str, np.ndarray]


def log(seed: int) -> Table:
    """Five periods of the planar arm with dry friction and encoders at its motors."""
    random = np.random.default_rng([41, seed])
    t = np.arange(0.0, 5 * PERIOD, 0.004)
    q, dq, ddq = motion(t, random.uniform(0.0, 2 * np.pi, (2, len(WAVES))))
    current = PLAIN[2].currents(q, dq, ddq) + np.sign(dq) * np.divide((0.018, 0.011), CONSTANT)
    current += 0.01 * random.normal(size=q.shape)
    count = 2 * np.pi / COUNTS / np.array(RATIO)
    q = count * np.rint(q / count)
    return {"t": t, "q1": q[:, 0], "q2": q[:, 1], "i1": current[:, 0], "i2": current[:, 1]}


def of_motors(table: Table) -> Table:
    return table | {f"q{k + 1}": RATIO[k] * table[f"q{k + 1}"] for k in range(2)}


def one_in_degrees(table: Table) -> Table:
    return table | {"q2": np.degrees(table["q2"])}


@pytest.mark.parametrize("seed", [0, 1, 2])
@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (of_motors, "are the positions q1, q2 those of the motors (qm<n>)? Then 0."),
        (one_in_degrees, "are the positions in degrees (q2)? Then 0."),
    ],
)
def test_the_reading_that_leaves_least_is_asked_about(
    wrong: Callable[[Table], Table], said: str, seed: int
) -> None:
    """Rest of one reading is not that of another, whose speeds are a hundred times those."""
    with pytest.raises(mg.InputError) as refused:
        mg.identify(ARM, wrong(log(2 * seed)), wrong(log(2 * seed + 1)))
    assert said in str(refused.value)


def test_the_log_as_it_is_raises_no_question() -> None:
    assert mg.identify(ARM, log(0), log(1)).to_json()["doubts"] == []
