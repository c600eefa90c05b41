"""What is hidden in an arm that MuJoCo simulates is found, and nothing is named where nothing is."""

from __future__ import annotations

import pytest
from mujoco_arm import description, log

import modelgen as mg
from modelgen.description import loads
from modelgen.effects import known_effects

DAMPER = (
    '<tendon><fixed damping="3"><joint joint="j2" coef="1"/><joint joint="j3" coef="-1"/></fixed></tendon>'
)


@pytest.fixture(scope="module")
def arm() -> mg.Arm:
    return loads(description(), "arms.yaml", known_effects())["arm"]


def test_nothing_is_named_where_mujoco_hides_nothing(arm: mg.Arm) -> None:
    """Its joints creep before they go, for which the catalogue has no law."""
    a, b, c = (log(seed) for seed in (1, 2, 3))
    data = mg.diagnose(arm, train=[a, b], test=c, experiment=False).to_json()
    assert data["causes"] == []


def test_a_payload_in_one_record_is_weighed(arm: mg.Arm) -> None:
    """What creeps beside it may make a suspect of it."""
    a, b, c = log(1), log(2, payload=0.5), log(3)
    data = mg.diagnose(arm, train=[a, b], test=c, experiment=False).to_json()
    assert [x["effect"] for x in data["causes"]] in ([], ["payload_change"])
    (found,) = [x for x in data["causes"] + data["suspects"] if x["effect"] == "payload_change"]
    assert found["parameters"]["mass"]["value"] == pytest.approx(0.5, rel=0.03)
    assert found["parameters"]["x"]["value"] == pytest.approx(0.3, rel=0.03)


def test_a_damper_between_two_joints_is_a_coupling(arm: mg.Arm) -> None:
    """As a tendon that is damped it brakes the difference of their speeds."""
    a, b, c = (log(seed, tendon=DAMPER) for seed in (1, 2, 3))
    data = mg.diagnose(arm, train=[a, b], test=c, experiment=False).to_json()
    (cause,) = data["causes"]
    assert cause["effect"] == "transmission_coupling"
    assert {cause["joint"], cause["parameters"]["other"]["value"]} == {2, 3}
    damping = cause["parameters"]["viscous"]
    assert damping["value"] == pytest.approx(3.0, rel=0.05)
