"""The model of the noise that covariances rest on, against what is known of the lags themselves."""

import numpy as np
import pytest
from scipy.signal import lfilter

from modelgen.dataset.processing.filters import low_pass, row_autocorrelation
from modelgen.numeric import Array
from modelgen.regression.autocovariance import autoregression
from modelgen.regression.least_squares import Regression


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


CUTOFF, RATE, STRIDE, COUNT = 1.0, 25.0, 10, 20


def filtered(random: np.random.Generator) -> Array:
    """White noise of samples through the parallel filter, at the rows."""
    samples = random.normal(size=(STRIDE * (COUNT + 20), 1))
    return low_pass(samples, CUTOFF, RATE, 4)[STRIDE * 10 :: STRIDE, 0][:COUNT]


def test_rows_hang_together_as_the_filter_has_it() -> None:
    random, lags = np.random.default_rng(1), 5
    seen = np.zeros(lags)
    for _ in range(3000):
        rows = filtered(random)
        seen += [rows[k:] @ rows[: COUNT - k] / (COUNT - k) for k in range(lags)]
    known = row_autocorrelation(CUTOFF, RATE, 4, STRIDE, lags)
    assert seen / seen[0] == pytest.approx(known, abs=0.02)
    assert known[1] > 0.2


def test_deviations_hold_where_a_fit_has_most_of_few_rows() -> None:
    """Slow columns take the band that the filter passes: what is left is less noise than they have."""
    random = np.random.default_rng(2)
    t = np.arange(COUNT) * STRIDE / RATE
    waves = [f(2 * np.pi * k * t / (COUNT * STRIDE / RATE)) for k in range(1, 6) for f in (np.sin, np.cos)]
    table, moving = np.column_stack(waves)[:, None], np.ones((COUNT, 1), dtype=bool)
    known = row_autocorrelation(CUTOFF, RATE, 4, STRIDE, 13)
    apart: dict[bool, list[Array]] = {True: [], False: []}
    for _ in range(300):
        rows = filtered(random)
        for white, shape in ((True, known), (False, None)):
            found = Regression([rows[:, None]], [table], [moving], shape).solve("ols")
            apart[white].append(found.theta / np.sqrt(np.diag(found.covariance)))
    covered = {white: float((np.abs(z) < 1.96).mean()) for white, z in apart.items()}
    assert covered[False] < 0.9
    assert 0.93 < covered[True] < 0.99
