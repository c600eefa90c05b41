"""One training log of a few periods measures noise and lack of fit, in diagnose and identify alike."""

from pathlib import Path

import pytest
from made_up_plants import PERIOD, PLAIN, PLANTS, description, log

import modelgen as mg
from modelgen.description import loads
from modelgen.effects import known_effects

ARM = loads(description(1), "arms.yaml", known_effects())["made_up"]


def asked(folder: Path, periods: int, plant: str = "") -> mg.Diagnosis:
    made = PLANTS[plant] if plant else PLAIN[1]
    train, test = log(folder / "one.csv", made, 1, periods), log(folder / "two.csv", made, 2)
    return mg.diagnose(ARM, train, test, experiment=False, effects=["friction_offset:1"])


def test_three_periods_measure_the_noise(tmp_path: Path) -> None:
    """With the model that made the log the lack of fit is chance, with another one it is found."""
    complete, lacking = asked(tmp_path, 3).to_json(), asked(tmp_path, 3, "geared_counterweight").to_json()
    assert complete["verdict"] == "nothing_missing"
    assert complete["lack_of_fit"]["statistic"] < complete["lack_of_fit"]["threshold"]
    assert lacking["lack_of_fit"]["statistic"] > lacking["lack_of_fit"]["threshold"]
    assert [r["samples"] for r in complete["log"]["records"]] == [800, 400, 1200]
    assert complete["log"]["period_s"] == pytest.approx(PERIOD)
    assert any("3 periods of 4 s, 2 before and 1 after" in x for x in complete["log"]["remarks"])


def test_of_two_periods_nothing_repeats_and_it_is_said(tmp_path: Path) -> None:
    found = asked(tmp_path, 2)
    said = found.to_json()
    assert (said["verdict"], said["lack_of_fit"]) == ("cannot_tell", None)
    assert any("1 before and 1 after: neither part repeats" in line for line in found.found.log.lines())


def test_identify_holds_whole_periods_out(tmp_path: Path) -> None:
    one = log(tmp_path / "one.csv", PLAIN[1], 1, 3)
    said = mg.identify(ARM, one).to_json()
    train, test = said["log"]["records"]
    assert (train["use"], train["samples"], train["period_s"]) == ("train", 800, pytest.approx(PERIOD))
    assert (test["use"], test["samples"]) == ("test", 400)
    assert any("2 before and 1 after" in x for x in said["log"]["remarks"])
    with pytest.raises(mg.InputError, match="found no test record"):
        mg.identify(ARM, [one, log(tmp_path / "two.csv", PLAIN[1], 2)])
