"""One training log of a few periods measures noise and lack of fit, in diagnose and identify alike."""

from pathlib import Path

import numpy as np
import pytest
from made_up_plants import (
    CENTRE,
    COUNT,
    NOISE,
    PERIOD,
    PLAIN,
    PLANTS,
    RATE,
    RATIO,
    WAVES,
    description,
    log,
    motion,
)

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


def with_a_way_in(seed: int, periods: int, seconds: float = 1.5) -> dict[str, np.ndarray]:
    """A log whose motion grows from rest into its periods."""
    plant, random = PLAIN[1], np.random.default_rng(seed)
    t = np.arange(round((periods * PERIOD + seconds) * RATE)) / RATE
    phase = random.uniform(0.0, 2 * np.pi, (1, len(WAVES)))

    def grown(t: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        q, dq, ddq = (x[:, 0] for x in motion(t - seconds, phase))
        x = np.clip(t / seconds, 0.0, 1.0)
        f = x**3 * (10 - 15 * x + 6 * x**2)
        df = 30 * x**2 * (1 - x) ** 2 / seconds
        ddf = 60 * x * (1 - x) * (1 - 2 * x) / seconds**2
        y = q - CENTRE[0]
        found = CENTRE[0] + f * y, df * y + f * dq, ddf * y + 2 * df * dq + f * ddq
        return tuple(x[:, None] for x in found)  # type: ignore[return-value]

    current = plant.currents(*grown(t + 0.5 / RATE))[:, 0] + NOISE * random.standard_normal(len(t))
    return {
        "t": t,
        "qm1": RATIO[0] * grown(t)[0][:, 0] + COUNT * random.standard_normal(len(t)),
        "i1": current,
    }


def test_a_way_into_the_motion_does_not_hide_that_it_repeats() -> None:
    train, test = [with_a_way_in(seed, 3) for seed in (1, 2)], with_a_way_in(3, 2)
    found = mg.diagnose(ARM, train, test, experiment=False, effects=["friction_offset:1"]).to_json()
    assert found["verdict"] == "nothing_missing"
    assert found["log"]["period_s"] == pytest.approx(PERIOD, rel=1e-3)
    said = [x for x in found["log"]["remarks"] if "the motion repeats every" in x]
    assert len(said) == 2
    assert all("what is before is left out" in x for x in said)
    said = mg.identify(ARM, train, test).to_json()["log"]
    assert said["period_s"] == pytest.approx(PERIOD, rel=1e-3)
    assert said["samples"] == sum(len(x["t"]) for x in train)  # of which the fit has all


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
