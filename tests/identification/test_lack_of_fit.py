"""What a model leaves alike in every period is no noise, and the answer says that deviations do not hold it.

The logs are those of a link by its own equation, with a law that the description may lack.
"""

from __future__ import annotations

import numpy as np
import pytest
from geared_link import LINK, PERIOD, sines

import modelgen as mg
from modelgen.description import loads
from modelgen.effects import known_effects
from modelgen.identification.beside_noise import Lacking

Table = dict[str, np.ndarray]


def lacking(found: mg.Identification) -> list[Lacking]:
    """The doubts about a model that lacks something."""
    return [doubt for doubt in found.outcome.found.doubts if isinstance(doubt, Lacking)]


def link_log(seed: int, count: float, besides: float = 0.0) -> Table:
    """A log of the geared link. count: steps of the motor's angle [rad]; besides: current [A] that grows
    with the square of the speed, and against it.
    """
    random = np.random.default_rng(seed)
    t = np.arange(0.0, 4 * PERIOD, 0.005)
    q, dq, ddq = sines(t, random.uniform(0, 6.28, 4))
    current = LINK.currents(q, dq, ddq) + besides * dq * np.abs(dq)
    motor = LINK.ratio * q
    motor = count * np.rint(motor / count) if count else motor
    return {"t": t, "qm1": motor, "i1": current + 0.01 * random.normal(size=len(t))}


@pytest.mark.parametrize("bits", [0, 10, 12, 14])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_coarse_positions_that_repeat_are_no_lack_of_fit(seed: int, bits: int) -> None:
    arm = loads(LINK.description(values=False), "arms.yaml", known_effects())["one"]
    count = LINK.ratio * 2 * np.pi / 2**bits if bits else 0.0
    found = mg.identify(arm, link_log(seed, count), link_log(seed + 10, count))
    assert not lacking(found)
    fit = found.outcome.found.remains
    assert fit is not None
    assert not len(fit.found)


@pytest.mark.parametrize("bits", [0, 14])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_a_law_that_is_missing_is_one(seed: int, bits: int) -> None:
    arm = loads(LINK.description(values=False), "arms.yaml", known_effects())["one"]
    count = LINK.ratio * 2 * np.pi / 2**bits if bits else 0.0
    found = mg.identify(arm, link_log(seed, count, 0.1), link_log(seed + 10, count, 0.1))
    truth = LINK.parameters["FV1"]
    estimate = found.parameters["FV1"]
    assert estimate.std is not None
    assert abs(estimate.value - truth) > 5 * estimate.std
    assert lacking(found)
    assert found.to_json()["lack_of_fit"]["statistic"][0] > found.to_json()["lack_of_fit"]["threshold"][0]


def test_where_nothing_repeats_there_is_none() -> None:
    arm = loads(LINK.description(values=False), "arms.yaml", known_effects())["one"]
    log, other = link_log(0, 0.0), link_log(1, 0.0)
    once = {name: values[: int(1.1 * PERIOD / 0.005)] for name, values in log.items()}
    found = mg.identify(arm, once, other)
    assert found.outcome.found.remains is None
    assert "lack_of_fit" not in found.to_json()
