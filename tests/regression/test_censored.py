"""Parameters from readings that are bounds, against the truth and against normal probabilities."""

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.stats import norm

from modelgen.numeric import Array
from modelgen.regression.censored import Samples, censored

TRUTH = np.array([2.0, -1.0])


def made(seed: int, limit: float, width: float = np.inf, count: int = 4000, noise: float = 0.3) -> Samples:
    """A line with noise that ends at a limit; of a bounded one what is beyond the bound is not there."""
    random = np.random.default_rng(seed)
    columns = np.column_stack([random.uniform(-1, 1, count), np.ones(count)])
    value = columns @ TRUTH + noise * random.normal(size=count)
    kept = value < limit + width
    columns, value = columns[kept], value[kept]
    side = (value > limit).astype(np.intp)
    return Samples(columns, np.where(side == 1, limit, value), side, width)


@pytest.mark.parametrize("seed", range(3))
def test_what_is_cut_off_does_not_bias(seed: int) -> None:
    """Half of the samples are at the limit: a fit to them as they stand is far off."""
    cut = made(seed, -1.0)
    plain = np.linalg.lstsq(cut.columns, cut.value, rcond=None)[0]
    found = np.zeros(2)
    for _ in range(5):
        found = censored([cut], found)
    assert np.abs(plain - TRUTH).max() > 0.4
    assert found == pytest.approx(TRUTH, abs=0.05)


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("width", [0.5, np.inf])
def test_it_is_the_largest_likelihood(sign: int, width: float) -> None:
    """Two joints, one of which has readings without a bound, against a search over normal probabilities."""
    one, two = made(1, -0.5, width, 300), made(2, 9.0, count=100, noise=0.1)
    cut = Samples(sign * one.columns, sign * one.value, sign * one.side, width)
    start = TRUTH + 0.1
    left = [np.abs(x.value - x.columns @ start)[x.side == 0] for x in (cut, two)]
    sizes = [1.4826 * float(np.median(x)) for x in left]

    def lost(theta: Array) -> float:
        total = 0.0
        for x, size in zip((cut, two), sizes, strict=True):
            z = (x.columns @ theta - x.value) / size
            u = (x.side * z)[x.side != 0]
            total -= norm.logpdf(z[x.side == 0]).sum()
            total -= np.log(norm.cdf(u) - norm.cdf(u - x.width / size)).sum()
        return float(total)

    expected = minimize(lost, TRUTH, method="Nelder-Mead", options={"xatol": 1e-8, "fatol": 1e-10}).x
    assert censored([cut, two], start) == pytest.approx(expected, abs=1e-6)


def test_a_start_far_off_ends_at_the_same_place() -> None:
    cut = made(4, -1.0)
    near, far = TRUTH, TRUTH + np.array([30.0, -20.0])
    for _ in range(16):
        near, far = censored([cut], near), censored([cut], far)
    assert far == pytest.approx(near, abs=1e-3)


def test_a_column_of_zeros_stays_as_it_is() -> None:
    cut = made(5, -1.0)
    wide = Samples(np.column_stack([cut.columns, np.zeros(len(cut.value))]), cut.value, cut.side)
    assert censored([wide], np.zeros(3))[2] == 0.0
