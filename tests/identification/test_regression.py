"""Estimators and their uncertainty against data whose truth is known."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lfilter

from modelgen.identification import Regression, Triangle

TRUTH = np.array([3.0, -1.0, 0.5])


def regression(seed: int, rho: float, outliers: int = 0) -> Regression:
    t = np.arange(800) / 50.0
    table = np.stack(
        [
            np.column_stack([np.sin(t), np.cos(0.7 * t), np.zeros(len(t))]),
            np.column_stack([np.zeros(len(t)), np.sin(1.3 * t), np.sign(np.cos(2.1 * t))]),
        ],
        axis=1,
    )
    noise = np.random.default_rng(seed).normal(size=(len(t), 2)) * [0.1, 1.0]
    noise = lfilter([np.sqrt(1.0 - rho**2)], [1.0, -rho], noise, axis=0)
    effort = table @ TRUTH + noise
    effort[:outliers, 1] += 40.0
    return Regression([effort], [table], [np.ones((len(t), 2), dtype=bool)])


def test_triangle_in_blocks_is_least_squares_of_the_whole() -> None:
    rng = np.random.default_rng(1)
    a, y = rng.normal(size=(500, 5)) * [1, 1e4, 1e-4, 1, 1], rng.normal(size=500)
    triangle = Triangle(5)
    for k in range(0, 500, 37):
        triangle.add(a[k : k + 37], y[k : k + 37])
    assert triangle.r.shape == (6, 6)
    assert triangle.solve()[0] == pytest.approx(np.linalg.lstsq(a, y, rcond=None)[0], rel=1e-9)


def test_what_the_rows_do_not_determine_is_said() -> None:
    triangle = Triangle(2)
    triangle.add(np.column_stack([np.arange(9.0), np.zeros(9)]), 2.0 * np.arange(9.0))
    theta, known, _ = triangle.solve()
    assert theta == pytest.approx([2.0, 0.0])
    assert known.tolist() == [True, False]


@pytest.mark.parametrize("rho", [0.0, 0.9])
def test_intervals_cover_the_truth_with_white_and_coloured_noise(rho: float) -> None:
    found = [regression(seed, rho).solve() for seed in range(200)]
    theta = np.array([s.theta for s in found])
    std = np.array([np.sqrt(np.diag(s.covariance)) for s in found])
    covered = np.mean(np.abs(theta - TRUTH) < 1.96 * std)
    assert 0.90 <= covered <= 0.99
    ratio = std.mean(axis=0) / theta.std(axis=0)
    assert np.all((ratio > 0.7) & (ratio < 1.5))


@pytest.mark.parametrize("rho", [0.0, 0.7])
def test_claimed_deviations_hold_where_the_fit_takes_much_of_the_noise_in_its_band(rho: float) -> None:
    # 150 rows, ten columns in the lowest 3 % of the frequencies: the fit takes all of the noise there, and
    # the residuals' own autocovariance would claim 0.63 and 0.50 of the scatter.
    t = np.arange(150.0)
    waves = [f(2 * np.pi * k * t / 160) for k in range(1, 6) for f in (np.sin, np.cos)]
    table = np.column_stack(waves)[:, None, :]
    theta, std = [], []
    for seed in range(200):
        noise = np.random.default_rng(seed).normal(size=(len(t) + 50, 1))
        noise = lfilter([np.sqrt(1.0 - rho**2)], [1.0, -rho], noise, axis=0)[50:]
        found = Regression([noise], [table], [np.ones((len(t), 1), dtype=bool)]).solve()
        theta.append(found.theta)
        std.append(np.sqrt(np.diag(found.covariance)))
    ratio = np.mean(std, axis=0) / np.std(theta, axis=0)
    assert 0.9 < ratio.mean() < 1.1
    assert np.all((ratio > 0.7) & (ratio < 1.5))


def test_noise_that_joints_share_is_taken_into_account() -> None:
    # Joint 1 has a tenth of the noise of joint 2 and the same on top: nearly all of it can be taken off.
    t = np.arange(600) / 50.0
    table = np.stack(
        [
            np.column_stack([np.sin(t), np.cos(0.7 * t), np.zeros(len(t))]),
            np.column_stack([np.zeros(len(t)), np.sin(1.3 * t), np.sign(np.cos(2.1 * t))]),
        ],
        axis=1,
    )
    found = {"wls": [], "gls": []}  # type: dict[str, list[np.ndarray]]
    claimed = []
    moving = np.ones((len(t), 2), dtype=bool)
    moving[:100, 0] = moving[550:, 1] = False  # not always both
    for seed in range(100):
        rng = np.random.default_rng(seed)
        shared, own = rng.normal(size=(2, len(t)))
        noise = np.column_stack([shared + 0.1 * own, shared])
        effort = table @ TRUTH + noise
        effort[~moving] = 1e3  # what does not count is not looked at
        for method, thetas in found.items():
            solution = Regression([effort], [table], [moving]).solve(method)
            thetas.append(solution.theta)
        claimed.append(np.sqrt(np.diag(solution.covariance)))
    wls, gls = (np.array(found[m]) for m in ("wls", "gls"))
    assert (gls.std(axis=0) < 0.5 * wls.std(axis=0)).all()
    assert np.abs(gls.mean(axis=0) - TRUTH).max() < 4 * gls.std(axis=0).max() / np.sqrt(len(gls))
    ratio = np.mean(claimed, axis=0) / gls.std(axis=0)
    assert ((ratio > 0.7) & (ratio < 1.5)).all()


def test_robust_weights_hold_against_outliers() -> None:
    plain, robust = (
        np.abs(regression(3, 0.0, outliers=80).solve(m).theta - TRUTH).max() for m in ("ols", "robust")
    )
    assert robust < 0.3 < plain
