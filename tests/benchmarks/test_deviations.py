"""Coarse positions: the cut-off is low enough, deviations hold, and where they cannot the answer is no."""

import pytest
from deviations import Encoder, arm, covered, log

import modelgen as mg


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
