"""The optimiser's criteria and their derivatives."""

import casadi as ca
import numpy as np
import pytest

from modelgen.excitation.spectrum import POWER, Criterion, condition, value_and_slope


def gram(p: int = 6) -> np.ndarray:
    w = np.random.default_rng(4).normal(size=(40, p)) @ np.diag(10.0 ** np.arange(p))
    return w.T @ w


def test_the_smooth_condition_number_is_near_the_true_one() -> None:
    w = np.random.default_rng(4).normal(size=(40, 6)) * 10.0 ** np.arange(6)
    smooth = np.exp(value_and_slope("cond", w.T @ w)[0])
    true = np.linalg.cond(w / np.linalg.norm(w, axis=0))
    assert condition(w) == pytest.approx(true)
    assert true <= smooth <= true * 6 ** (1 / POWER)


def test_the_determinant() -> None:
    g = gram()
    assert value_and_slope("d_optimal", g)[0] == pytest.approx(-np.linalg.slogdet(g)[1] / 12)


@pytest.mark.parametrize("criterion", ["cond", "d_optimal"])
def test_derivatives_are_those_of_finite_differences(criterion: str) -> None:
    g = gram()
    slope = value_and_slope(criterion, g)[1]
    rng = np.random.default_rng(5)
    for _ in range(5):
        d = rng.normal(size=g.shape)
        d = (d + d.T) * np.sqrt(np.outer(np.diag(g), np.diag(g))) * 1e-6
        difference = value_and_slope(criterion, g + d)[0] - value_and_slope(criterion, g - d)[0]
        assert np.sum(slope * d) == pytest.approx(difference / 2, rel=1e-5)


@pytest.mark.parametrize("criterion", ["cond", "d_optimal"])
def test_casadi_has_the_same_derivative(criterion: str) -> None:
    g, function = gram(), Criterion(criterion, 6)
    x = ca.MX.sym("x")
    direction = np.diag(np.diag(g))
    direction[0, 0] *= 3
    f = ca.Function("f", [x], [ca.gradient(function(ca.DM(g) + x * ca.DM(direction)), x)])
    assert float(f(0.0)) == pytest.approx(np.sum(value_and_slope(criterion, g)[1] * direction))


def test_a_column_of_zeros_is_no_condition_number() -> None:
    assert condition(np.array([[1.0, 0.0], [2.0, 0.0]])) == np.inf
