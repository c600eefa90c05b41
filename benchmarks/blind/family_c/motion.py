"""Commanded motions: a Fourier series over whole periods, or work of which nothing repeats."""

from __future__ import annotations

import numpy as np

from blind.case import Array
from blind.family_c.plant import TICK

WORK = ("transfer", "jogging", "sweep")
Numbers = np.random.Generator
Span = tuple[Array, Array, Array]  # centre, reach and highest speed of each joint


def periodic(rng: Numbers, span: Span, period: float, orders: int, times: Array) -> Array:
    """Joint coordinates (N, n) of a Fourier series, as fast and as wide as the span allows."""
    centre, reach, speed = span
    order = np.arange(1, orders + 1)
    weight = rng.uniform(0.3, 1.0, (len(centre), orders)) / np.sqrt(order)
    phase = rng.uniform(0, 2 * np.pi, (len(centre), orders))

    def wave(t: Array, rates: bool) -> Array:
        angle = 2 * np.pi * order * t[:, None, None] / period + phase
        shape = np.cos(angle) * 2 * np.pi * order / period if rates else np.sin(angle)
        total: Array = (weight * shape).sum(axis=2)
        return total

    grid = np.linspace(0, period, 800, endpoint=False)
    high, low = wave(grid, False).max(axis=0), wave(grid, False).min(axis=0)
    size = np.minimum(2 * reach / (high - low), speed / np.abs(wave(grid, True)).max(axis=0))
    q: Array = centre + size * (wave(times, False) - (high + low) / 2)
    return q


def work(rng: Numbers, kind: str, span: Span, times: Array) -> Array:
    """Joint coordinates (N, n) of ordinary work. kind: one of WORK; before time 0 the arm waits."""
    centre, reach, speed = span
    if kind == "sweep":
        return _sweep(rng, span, times)
    q = np.tile(centre, (len(times), 1))
    here, k = centre.copy(), int(np.searchsorted(times, 0.0))
    while k < len(times):
        there = centre + reach * rng.uniform(-1, 1, len(centre))
        if kind == "jogging":
            kept = rng.random(len(centre)) < 0.6
            kept[rng.integers(len(centre))] = False
            there = np.where(kept, here, there)
        pace = rng.uniform(0.4, 1.0)
        seconds = max(float((np.abs(there - here) / speed).max()) / pace, 0.25) * 1.5
        u = np.arange(1, max(2, int(seconds / TICK)) + 1) * TICK / seconds
        path = _ramps(u) if kind == "jogging" else _cycloid(u)
        pause = int(rng.uniform(0.1, 0.8) / TICK)
        rows = np.concatenate([here + path[:, None] * (there - here), np.tile(there, (pause, 1))])
        rows = rows[: len(times) - k]
        q[k : k + len(rows)] = rows
        k += len(rows)
        here = there
    return q


def _cycloid(u: Array) -> Array:
    """Way from 0 to 1: half a cosine, its ends rounded by a sine of the double frequency."""
    u = np.minimum(u, 1.0)
    s: Array = u - np.sin(2 * np.pi * u) / (2 * np.pi)
    return s


def _ramps(u: Array) -> Array:
    """Way from 0 to 1 with a third of the time at either end for a steady acceleration."""
    u = np.minimum(u, 1.0)
    s = np.where(u < 1 / 3, 2.25 * u**2, 1.5 * u - 0.25)
    out: Array = np.where(u > 2 / 3, 1 - 2.25 * (1 - u) ** 2, s)
    return out


def _sweep(rng: Numbers, span: Span, times: Array) -> Array:
    """Sines whose frequency rises geometrically, the faster the smaller; each joint at its own pace."""
    centre, reach, speed = span
    t, end = np.maximum(times, 0.0)[:, None], float(times[-1])
    first, last = rng.uniform(0.04, 0.08, len(centre)), rng.uniform(0.3, 0.6, len(centre))
    growth = np.log(last / first) / end
    phase = 2 * np.pi * first * np.expm1(growth * t) / growth
    wide = speed / (2 * np.pi * first * np.exp(growth * t))
    size = reach * wide / np.hypot(reach, wide)
    slow = 0.3 * reach * np.sin(2 * np.pi * rng.uniform(0.02, 0.05, len(centre)) * t)
    begun = 1 - np.exp(-(t**2) / 2)  # from rest
    q: Array = centre + begun * (0.7 * size * np.sin(phase) + slow)
    return q
