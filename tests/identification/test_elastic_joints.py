"""An arm that is described with an elastic joint is identified as it is, from either side of the joint."""

from __future__ import annotations

import pytest
from belt_rig import ARM, MASS, STIFFNESS, WHOLE, log, rig

import modelgen as mg


def found(stiffness: float, side: str) -> mg.IdentificationResult:
    return mg.identify(rig(stiffness), log(0, side), log(1, side))


@pytest.mark.parametrize("side", ["motor", "link"])
def test_parameters_beside_an_elastic_joint(side: str) -> None:
    """Those of the arm; without the belt's give its inertia is another."""
    soft, stiff = found(STIFFNESS, side).parameters, found(1e6, side).parameters
    assert soft["ZZ1R"].value == pytest.approx(WHOLE, rel=0.01)
    assert soft["MX1"].value == pytest.approx(MASS * ARM, rel=0.003)
    assert abs(stiff["ZZ1R"].value / WHOLE - 1.0) > 0.04


def test_a_joint_that_is_far_too_soft_is_asked_about() -> None:
    assert any("unexplained" in doubt for doubt in found(30.0, "motor").to_json()["doubts"])


@pytest.mark.parametrize("side", ["motor", "link"])
def test_one_that_is_as_stiff_as_described_is_asked_nothing(side: str) -> None:
    assert found(STIFFNESS, side).to_json()["doubts"] == []


@pytest.mark.parametrize("side", ["motor", "link"])
def test_the_data_say_when_efforts_were_read_beside_an_elastic_joint(side: str) -> None:
    """What the joint adds is in what delays are fitted to; parameters are then known by far better."""
    result = found(STIFFNESS, side)
    instant = result.to_json()["log"]["effort_instant"]
    assert (instant["hold"], instant["known_from"]) == ("instant", "data")
    for name, truth in (("ZZ1R", WHOLE), ("MX1", MASS * ARM)):
        estimate = result.parameters[name]
        assert estimate.value == pytest.approx(truth, rel=5e-4)
        assert estimate.std < 3e-4 * truth
    assert result.to_json()["lack_of_fit"]["statistic"][0] < 2.0


def test_nothing_is_missing_where_the_elastic_joint_is_described() -> None:
    """Effects that depend on loads are asked beside the states of the joint."""
    again = mg.diagnose(rig(STIFFNESS), [log(0), log(2)], log(1), experiment=False, processes=1)
    assert again.verdict == "nothing_missing"
    fit = again.to_json()["lack_of_fit"]
    assert fit["statistic"] < fit["threshold"]
