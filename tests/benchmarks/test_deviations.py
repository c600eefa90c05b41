"""Coarse positions: the cut-off is low enough, deviations hold, and where they cannot the answer is no."""

from collections.abc import Mapping

import numpy as np
import pytest
from deviations import Encoder, arm, covered, log

import modelgen as mg
from modelgen.numeric import Array


@pytest.mark.parametrize(
    ("encoder", "highest"),
    [(Encoder(8), 2.0), (Encoder(10), 4.0), (Encoder(12), 7.0), (Encoder(9, repeats=6), 2.5)],
)
def test_deviations_hold_however_coarse_the_positions_are(encoder: Encoder, highest: float) -> None:
    found = covered(encoder, range(6))
    assert len(found.hits) >= 5
    assert max(found.cutoffs) < highest  # Hz, of motions up to 0.5 Hz
    # 60 intervals: fewer than 82 % in one run of a thousand, if each holds in 95 %.
    assert found.hits.mean() > 0.82


def test_steps_that_hide_the_motion_are_refused_in_one_line() -> None:
    model = mg.build_model(arm())
    train, test = (log(model, Encoder(5), seed) for seed in (1, 2))
    with pytest.raises(mg.InputError, match=r"too coarse: steps of 0\.196 feign .* what would help"):
        mg.identify(arm(), train, test)


@pytest.mark.parametrize(("step", "limit"), [(0.25, 0.8), (0.5, 0.9), (0.0, 0.8)])
def test_deviations_hold_where_currents_are_coarse_and_cut_off(step: float, limit: float) -> None:
    """Of some of the logs one current has six readings, and the highest is the most frequent one."""
    found = covered(Encoder(14, current=step, limit=limit), range(500, 506), scale=5.0)
    assert len(found.hits) == 6
    assert found.hits.mean() > 0.82


def remarks(table: Mapping[str, Array], model: mg.Model, step: float) -> list[str]:
    coarse = {name: step * np.rint(x / step) if name[0] == "i" else x for name, x in table.items()}
    found = mg.identify(arm(5.0), coarse, log(model, Encoder(14, current=step), 7))
    return [x for x in found.to_json()["log"]["remarks"] if "cut off" in x]


@pytest.mark.parametrize("step", [0.25, 0.5])
def test_coarse_currents_of_another_model_are_not_cut_off(step: float) -> None:
    """A spring and an amplifier that the model lacks: it would gain by clipping, and is not believed."""
    model = mg.build_model(arm(5.0))
    plain = log(model, Encoder(14), 1)
    most = {k: float(np.abs(plain[f"i{k}"]).max()) for k in (1, 2)}
    sprung = {f"i{k}": plain[f"i{k}"] + 0.3 * most[k] * np.sin(3 * plain[f"q{k}"]) for k in (1, 2)}
    bent = {f"i{k}": plain[f"i{k}"] * (1 + 0.3 * (plain[f"i{k}"] / most[k]) ** 2) for k in (1, 2)}
    for currents in ({}, sprung, bent):
        assert remarks(plain | currents, model, step) == []


def test_a_current_of_few_readings_that_is_cut_off_is_said() -> None:
    model = mg.build_model(arm(5.0))
    cut = log(model, Encoder(14, current=0.25, limit=0.8), 2)
    assert len(np.unique(cut["i2"])) < 10
    said = mg.identify(arm(5.0), cut, log(model, Encoder(14, current=0.25), 7)).to_json()["log"]["remarks"]
    assert any("effort of elbow is cut off at 3.25 A: the model asks for more" in x for x in said)
