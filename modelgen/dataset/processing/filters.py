"""Zero-phase filters and derivatives along the first axis of (N, k) arrays on a uniform time axis."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from scipy import signal

from modelgen.native import both_ways, central
from modelgen.numeric import Array

# Central differences by half-width: weights of x[i+k] - x[i-k] for the first derivative, of
# x[i+k] - 2 x[i] + x[i-k] for the second (Fornberg, 1988).
_FIRST = {1: (1 / 2,), 2: (2 / 3, -1 / 12), 3: (3 / 4, -3 / 20, 1 / 60)}
_SECOND = {1: (1.0,), 2: (4 / 3, -1 / 12), 3: (3 / 2, -3 / 20, 1 / 90)}


def low_pass(columns: Array, cutoff: float, rate: float, order: int) -> Array:
    """Butterworth forwards and backwards: zero phase, gain 1/2 at `cutoff` [Hz]. columns: (N, k)."""
    if len(columns) == 0 or columns.shape[1] == 0:
        return columns.copy()
    sos, states = _sections(cutoff, rate, order)
    padding = min(len(columns) - 1, reach(cutoff, rate, order, 1e-6))
    found = both_ways(columns, sos, states, padding)
    if found is None:
        found = np.asarray(signal.sosfiltfilt(sos, columns, axis=0, padlen=padding), dtype=np.float64)
    return found


@lru_cache(maxsize=64)
def _sections(cutoff: float, rate: float, order: int) -> tuple[Array, Array]:
    """Second-order sections of a Butterworth filter, and their states for a constant input of 1."""
    sos = signal.butter(order, cutoff, fs=rate, output="sos")
    return sos, signal.sosfilt_zi(sos)


@lru_cache(maxsize=64)
def reach(cutoff: float, rate: float, order: int, remainder: float) -> int:
    """Samples after which the filter's memory has fallen to `remainder`, by its slowest pole."""
    poles = signal.butter(order, cutoff, fs=rate, output="zpk")[1]
    return math.ceil(math.log(remainder) / math.log(float(np.max(np.abs(poles)))))


@lru_cache(maxsize=64)
def row_autocorrelation(cutoff: float, rate: float, order: int, stride: float, lags: int) -> Array:
    """Autocorrelation (lags,), from lag 0, of white noise through `low_pass`, at every `stride`-th sample."""
    f = (np.arange(1 << 14) + 0.5) / (1 << 15)  # of the rate
    power = (1.0 + (np.tan(np.pi * f) / np.tan(np.pi * cutoff / rate)) ** (2 * order)) ** -2.0
    found = np.cos(2 * np.pi * np.outer(np.arange(lags) * stride, f)) @ power
    return np.asarray(found / found[0])


def differences(x: Array, step: float, half_width: int) -> tuple[Array, Array]:
    """First and second derivative of x (N, k) by central differences of order 2 half_width.

    The outermost half_width samples repeat their neighbours' derivatives; they are for trimming.
    """
    count, h = len(x), half_width
    taps = [a / step for a in _FIRST[h]], [b / step**2 for b in _SECOND[h]]
    found = central(x, *taps) if count > 2 * h else None
    if found is not None:
        return found
    first, second = np.zeros_like(x), np.zeros_like(x)
    inner = slice(h, count - h)
    for k, (a, b) in enumerate(zip(*taps, strict=True), 1):
        ahead, behind = x[h + k : count - h + k], x[h - k : count - h - k]
        first[inner] += a * (ahead - behind)
        second[inner] += b * (ahead - 2 * x[inner] + behind)
    for derivative in (first, second):
        derivative[:h], derivative[count - h :] = derivative[h], derivative[count - h - 1]
    return first, second


def smoothed(
    columns: Array, step: float, cutoff: float, order: int, half_width: int
) -> tuple[Array, Array, Array]:
    """Columns (N, k) through the filter of the positions, 0 Hz: none, and their first two derivatives."""
    values = low_pass(columns, cutoff, 1.0 / step, order) if cutoff else columns.copy(order="K")
    return values, *differences(values, step, half_width)


def advanced(x: Array, delay: float, held: bool) -> Array:
    """x (N, k) at the instants of the stamps, where its samples lie `delay` periods after them.

    With |delay| = 1/2 and `held`, a sample is the mean over the period that it is in the middle of: what is
    returned has these means, of a cubic. Else cubic interpolation (Lagrange).
    """
    if held and abs(abs(delay) - 0.5) < 1e-9:
        # Response 2 a cos(3 w/2) + 2 b cos(w/2) = 1 / sinc(w/2) up to w^4: a = -1/12, b = 7/12.
        taps, first = np.array([-1.0, 7.0, 7.0, -1.0]) / 12.0, -2 if delay > 0 else -1
    else:
        whole = math.floor(-delay)
        f = -delay - whole
        if f < 1e-12:
            taps, first = np.array([1.0]), whole
        else:
            taps = np.array(
                [
                    -f * (f - 1) * (f - 2) / 6,
                    (f + 1) * (f - 1) * (f - 2) / 2,
                    -(f + 1) * f * (f - 2) / 2,
                    (f + 1) * f * (f - 1) / 6,
                ]
            )
            first = whole - 1
    before, after = max(0, -first), max(0, first + len(taps) - 1)
    longer = np.empty((x.shape[1], before + len(x) + after)).T  # columns in order in memory
    longer[:before], longer[before : before + len(x)], longer[before + len(x) :] = x[0], x, x[-1]
    result, term = np.zeros_like(x), np.empty_like(x)
    for k, tap in enumerate(taps, before + first):
        np.multiply(longer[k : k + len(x)], tap, out=term)
        result += term
    return result
