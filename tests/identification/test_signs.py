"""Efforts that are counted the other way are refused where the other sign explains them, and only there."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from made_up_plants import CENTRE, CONSTANT, PERIOD, WAVES, Plant, description, motion, planar

import modelgen as mg
from modelgen.description import loads

RATE, NOISE = 250.0, 0.01  # Hz, A
DRY = (0.018, 0.011)  # N m at the motor
Table = dict[str, np.ndarray]


def log(seed: int, turned: tuple[int, ...] = (), stiffness: float = 0.0) -> Table:
    """Five periods of the planar arm with dry friction. turned: joints (from 1) whose currents have the other
    sign. stiffness: of a spring at the second joint [N m/rad].
    """

    def spring(q: np.ndarray, dq: np.ndarray, ddq: np.ndarray) -> np.ndarray:
        return np.column_stack([np.zeros(len(q)), stiffness * (q[:, 1] - CENTRE[1])])

    random = np.random.default_rng([5, seed])
    t = np.arange(0.0, 5 * PERIOD, 1 / RATE)
    q, dq, ddq = motion(t, random.uniform(0.0, 2 * np.pi, (2, len(WAVES))))
    current = Plant(2, planar, spring).currents(q, dq, ddq) + np.sign(dq) * np.divide(DRY, CONSTANT)
    current = current + NOISE * random.standard_normal(current.shape)
    signs = [-1.0 if k + 1 in turned else 1.0 for k in range(2)]
    return {"t": t, **{f"q{k + 1}": q[:, k] for k in range(2)}} | {
        f"i{k + 1}": signs[k] * current[:, k] for k in range(2)
    }


@pytest.fixture(scope="module")
def arm() -> mg.Arm:
    """Of whose links nothing but the lengths is known."""
    text, _, _ = description(2).partition("    links:")
    return loads(text)["made_up"]


@pytest.mark.parametrize("turned", [(1,), (2,), (1, 2)])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_sign_that_is_wrong_is_refused(seed: int, turned: tuple[int, ...], arm: mg.Arm) -> None:
    with pytest.raises(mg.InputError, match="is their sign the other way round") as refused:
        mg.identify(arm, [log(3 * seed, turned), log(3 * seed + 1, turned)], log(3 * seed + 2, turned))
    joints = ", ".join(f"j{k}" for k in turned)
    assert f"friction at {joints} comes" in str(refused.value) or (
        f"sign of the efforts of {joints} " in str(refused.value)
    )


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_spring_that_the_model_lacks_is_no_wrong_sign(seed: int, arm: mg.Arm) -> None:
    """What is impossible is asked about, beside the numbers."""
    logs = [log(3 * seed + k, stiffness=20.0) for k in range(3)]
    found = mg.identify(arm, logs[:2], logs[2]).to_json()
    impossible = [x for x in found["doubts"] if "would drive j2" in x]
    assert impossible
    assert all("The model lacks something there (modelgen diagnose)" in x for x in impossible)


@pytest.mark.parametrize("seed", range(5))
def test_the_right_signs_raise_no_question(seed: int, arm: mg.Arm) -> None:
    found = mg.identify(arm, [log(3 * seed), log(3 * seed + 1)], log(3 * seed + 2)).to_json()
    assert found["doubts"] == []


@pytest.mark.parametrize("turned", [(1,), (2,)])
def test_a_diagnosis_asks_of_a_wrong_sign_what_identification_asks(
    turned: tuple[int, ...], arm: mg.Arm
) -> None:
    logs = [log(k, turned) for k in range(3)]
    for command in (mg.identify, mg.diagnose):
        given: dict[str, Any] = {"train": logs[:2], "test": logs[2]}
        with pytest.raises(mg.InputError, match="is their sign the other way round") as refused:
            command(arm, **given)
        assert f"j{turned[0]} " in str(refused.value)
