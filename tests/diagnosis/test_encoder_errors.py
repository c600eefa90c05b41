"""An encoder whose error repeats with each turn of its shaft is no spring, no play and no ripple."""

from __future__ import annotations

import numpy as np
import pytest
from geared_link import LINK, PERIOD, sines

import modelgen as mg
from modelgen.description import loads

Table = dict[str, np.ndarray]
SIZE = 0.006  # rad of the motor: a disc off its centre by a thousandth of 6 mm


@pytest.fixture(scope="module")
def arm() -> mg.Arm:
    return loads(LINK.description())["one"]


def log(seed: int, eccentric: float, ripple: float) -> Table:
    """Three periods. eccentric: error of the encoder [rad of the motor]. ripple: of the current [A]."""
    random = np.random.default_rng([seed, 11])
    t = np.arange(int(3 * PERIOD * 250.0)) / 250.0
    q, dq, ddq = sines(t, random.uniform(0.0, 6.28, 4))
    motor = LINK.ratio * q
    effort = LINK.currents(q, dq, ddq) + ripple * np.sin(motor + 0.7) + 0.01 * random.normal(size=len(t))
    read = motor + eccentric * np.sin(motor + 0.4) + 1e-4 * random.normal(size=len(t))
    return {"t": t, "qm1": read, "i1": effort}


def diagnosis(arm: mg.Arm, seed: int, eccentric: float = 0.0, ripple: float = 0.0) -> mg.Diagnosis:
    logs = [log(10 * seed + k, eccentric, ripple) for k in range(3)]
    return mg.diagnose(arm, logs[:2], logs[2], experiment=False)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_an_eccentric_encoder_is_said_and_no_cause_is_named(seed: int, arm: mg.Arm) -> None:
    found = diagnosis(arm, seed, eccentric=SIZE)
    assert not found.causes
    assert found.verdict == "outside_catalogue"
    most = found.to_json()["most_like"]["text"]
    assert most == "an error of the encoder that repeats with each turn of the motor at hip"


def test_a_ripple_of_the_torque_is_named_as_before(arm: mg.Arm) -> None:
    found = diagnosis(arm, 0, ripple=0.1)
    assert [(c.effect, c.joint) for c in found.causes] == [("torque_ripple", 1)]
    values = found.to_json()["causes"][0]["parameters"]
    assert values["harmonic"]["value"] == pytest.approx(1.0, abs=0.01)
    assert np.hypot(values["sine"]["value"], values["cosine"]["value"]) == pytest.approx(
        0.1 * LINK.constant, rel=0.1
    )
