"""The model of the noise that covariances rest on, against what is known of the lags themselves."""

import numpy as np
import pytest
from scipy.signal import lfilter

from modelgen.regression.autocovariance import autoregression


def test_an_autoregression_gives_back_the_lags_it_was_made_from() -> None:
    """The impulse response of the model has the given autocovariance: Yule and Walker, 1927 and 1931."""
    true = np.array([1.0, -1.2, 0.5])
    pulse = lfilter([1.0], true, np.eye(1, 4000)[0])
    lags = np.array([float(pulse[k:] @ pulse[: len(pulse) - k]) for k in range(13)])
    taps, power = autoregression(lags)
    assert taps[:3] == pytest.approx(true, abs=1e-6)
    assert taps[3:] == pytest.approx(0.0, abs=1e-6)
    assert power == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize(
    "lags",
    [
        [1.0, 0.9, -0.9, 0.1],
        [1.0, 1.4, 1.0, 0.6],
        [2.0, 1.9, 1.99, 1.2],
        [1.0, 0.0, 0.0, 3.0],
        [1.0, 1.0, 1.0, 1.0],
    ],
)
def test_lags_that_no_noise_can_have_still_give_a_stable_model(lags: list[float]) -> None:
    taps, power = autoregression(np.array(lags))
    assert len(taps) == len(lags)
    assert np.abs(np.roots(taps)).max(initial=0.0) < 1.0
    assert 0.0 <= power <= lags[0]
