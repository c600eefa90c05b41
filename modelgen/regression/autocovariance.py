"""Covariance of least-squares parameters whose residuals hang together from row to row.

A sandwich B (sum of X' G X) B: B the inverse of the weighted normal matrix, G the covariance of each joint's
noise, an autoregressive model. Residuals are not the noise: the fit has absorbed a part, most of it at the
slow frequencies at which the columns live, and their autocovariance alone claims too much. What the fit takes
follows from the model of the noise itself; it is added to what is seen, by fixed-point iteration. Where
few rows are left the power of the noise is uncertain too: deviations are those of Student's distribution.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.linalg import solve_toeplitz, toeplitz
from scipy.linalg.lapack import dpotrf
from scipy.signal import lfilter

from modelgen.numeric import Array

ORDER = 12  # of the autoregressive models
ROUNDS = 30  # of the iteration, at most
CHANGE = 1e-3  # of the power, at which it ends
FEW = 4.0  # degrees of freedom of a joint's noise, at least
TOLD = 100  # rows of a joint, by fewer of which the colour of its noise is not known
LEFT = 0.02  # of the noise's power, that a fit leaves at least
MANY = 1000  # rows per parameter, beyond which the fit has taken nothing that counts


def sandwich(
    columns: Sequence[Array],
    residuals: Sequence[Array],
    weights: Sequence[Array],
    white: Array | None = None,
) -> Array:
    """Covariance (p, p) of the parameters.

    By record: columns (M, n, p), residuals (M, n), weights (M, n), zero where a row does not count.
    Residuals of different joints count as independent. white: (lags,) autocorrelation that white noise of the
    samples has in the rows, from lag 0; None: not known.
    """
    n, p = columns[0].shape[1:]
    x = [[c[:, j] * w[:, j, None] for c, w in zip(columns, weights, strict=True)] for j in range(n)]
    e = [[r[:, j] * w[:, j] for r, w in zip(residuals, weights, strict=True)] for j in range(n)]
    count = [sum(int((w[:, j] > 0).sum()) for w in weights) for j in range(n)]
    normal = sum((part.T @ part for own in x for part in own), np.zeros((p, p)))
    size = np.sqrt(np.diag(normal))
    bread = np.linalg.inv(normal / np.outer(size, size)) / np.outer(size, size)
    seen = [autocovariance(own, number) for own, number in zip(e, count, strict=True)]
    noise = list(seen)
    for _ in range(ROUNDS if sum(count) < MANY * p else 0):
        taken = _taken(x, noise, bread, count)
        before, noise = noise, [a + b for a, b in zip(seen, taken, strict=True)]
        if all(abs(a[0] - b[0]) <= CHANGE * a[0] for a, b in zip(noise, before, strict=True)):
            break
    found = _covariance(x, noise, bread, count)
    if white is None or min((number for number in count if number), default=TOLD) >= TOLD:
        return found
    # A fit that takes most of few rows leaves what lies beside the band that the filter passes.
    other = np.diag(_covariance(x, _of_white(x, seen, bread, count, white), bread, count))
    larger = np.sqrt(np.maximum(other / np.maximum(np.diag(found), 1e-300), 1.0))
    return np.asarray(found * np.outer(larger, larger))


def _covariance(
    x: Sequence[Sequence[Array]], noise: Sequence[Array], bread: Array, count: Sequence[int]
) -> Array:
    few = [r * _student(own, r, bread, number) for own, r, number in zip(x, noise, count, strict=True)]
    return np.asarray(bread @ _meat(x, few)[0] @ bread)


def _of_white(
    x: Sequence[Sequence[Array]],
    seen: Sequence[Array],
    bread: Array,
    count: Sequence[int],
    white: Array,
) -> list[Array]:
    """Autocovariances by joint of filtered white noise, of which the fit leaves as much as is seen."""
    lags = [white[: max(1, min(len(white), number // 2))] for number in count]
    power = [float(r[0]) for r in seen]
    for _ in range(ROUNDS):
        noise = [p * shape for p, shape in zip(power, lags, strict=True)]
        taken = [float(lost[0]) for lost in _taken(x, noise, bread, count)]
        before = power
        power = [
            p * float(r[0]) / max(p - lost, LEFT * p) if p > 0.0 else 0.0
            for p, r, lost in zip(power, seen, taken, strict=True)
        ]
        if all(abs(a - b) <= CHANGE * a for a, b in zip(power, before, strict=True)):
            break
    return [p * shape for p, shape in zip(power, lags, strict=True)]


def _student(own: Sequence[Array], r: Array, bread: Array, count: int) -> float:
    """Variance of Student's distribution over that of the normal one, for what a joint's noise is known by.

    Rows count for as many as tell its power (Bartlett 1946), less the parameters that they are fitted by.
    """
    fitted = sum(float(np.vdot(part @ bread, part)) for part in own)
    independent = count / (1.0 + 2.0 * float(np.sum((r[1:] / r[0]) ** 2))) if r[0] > 0.0 else float(count)
    freedom = max(FEW, independent - fitted)
    return freedom / (freedom - 2.0)


def autocovariance(parts: Sequence[Array], count: int) -> Array:
    """Autocovariance of one joint by lag; parts (M,), zero where a row does not count; `count` rows do."""
    order = min(ORDER, count // 20)
    return np.array(
        [sum(float(e[lag:] @ e[: len(e) - lag]) for e in parts) for lag in range(order + 1)]
    ) / max(1, count)


def autoregression(r: Array) -> tuple[Array, float]:
    """Taps (1, a1, ...) and power of the innovations by Yule and Walker's equations.

    Lags that no noise can have (a matrix that is not positive definite) would give an unstable filter: the
    model has the order of the longest run of lags, from zero on, that a noise can have.
    """
    level = r + np.eye(len(r))[0] * 1e-9 * r[0]
    # LAPACK says the size of the first leading matrix that is not positive definite, 0 where all are.
    broken = dpotrf(toeplitz(level))[1] or len(r) + 1
    order = max(0, broken - 2)
    taps = np.eye(len(r))[0]
    if order == 0:
        return taps, max(0.0, float(r[0]))
    a = solve_toeplitz(level[:order], r[1 : order + 1])
    taps[1 : order + 1] = -a
    return taps, max(0.0, float(r[0] - a @ r[1 : order + 1]))


def meat_of(rows: Array, taps: Array, power: float) -> Array:
    """rows' G rows (p, p) of one record of one joint, G that of the noise power / |A(z)|^2."""
    back = lfilter([1.0], taps, rows[::-1], axis=0)
    return np.asarray(power * (back.T @ back))


def _meat(x: Sequence[Sequence[Array]], noise: Sequence[Array]) -> tuple[Array, list[list[Array]]]:
    """Sum of X' G X, and G X by joint and record.

    G of e = w / A(z) is power (1/A)(1/A)', filters run forwards and backwards (Ljung 1999, appendix II).
    """
    p = x[0][0].shape[1]
    meat, coloured = np.zeros((p, p)), []
    for own, r in zip(x, noise, strict=True):
        taps, power = autoregression(r)
        back = [lfilter([1.0], taps, part[::-1], axis=0)[::-1] for part in own]
        meat += power * sum((b.T @ b for b in back), np.zeros((p, p)))
        coloured.append([power * lfilter([1.0], taps, b, axis=0) for b in back])
    return meat, coloured


def _taken(
    x: Sequence[Sequence[Array]], noise: Sequence[Array], bread: Array, count: Sequence[int]
) -> list[Array]:
    """Share of each joint's autocovariance that the fit takes: lags of G - E[e e'],

    e = noise - X B sum(X' noise).
    """
    meat, coloured = _meat(x, noise)
    spread = bread @ meat @ bread
    result = []
    for own, own_coloured, r, number in zip(x, coloured, noise, count, strict=True):
        lost = np.zeros(len(r))
        for part, gx in zip(own, own_coloured, strict=True):
            xb, gb = part @ bread, gx @ bread
            left = gb - part @ spread
            for lag in range(len(r)):
                now, later = slice(0, len(part) - lag), slice(lag, None)
                lost[lag] += np.vdot(left[now], part[later]) + np.vdot(xb[now], gx[later])
        result.append(lost / max(1, number))
    return result
