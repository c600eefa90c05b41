"""Commanded motions: several periods of a Fourier series, or ordinary work that does not repeat."""

from __future__ import annotations

import numpy as np

from blind.case import Array
from blind.family_b.kernel import TICK

ORDINARY = ("pick_and_place", "jogging", "sweep")
Numbers = np.random.Generator


def fourier(rng: Numbers, span: tuple[Array, Array, Array], period: float, times: Array) -> Array:
    """Angles (N, 3) of five harmonics. span: centre, reach and highest speed of each axis."""
    centre, reach, speed = span
    grid = np.arange(0, period, 0.01)
    order = np.arange(1, 6)
    sine, cosine = rng.normal(size=(2, 3, 5)) / order**0.7

    def at(t: Array) -> Array:
        phase = 2 * np.pi * order * t[:, None] / period
        x: Array = np.sin(phase) @ sine.T + np.cos(phase) @ cosine.T
        return x

    x = at(grid)
    middle = (x.max(axis=0) + x.min(axis=0)) / 2
    wide = np.abs(x - middle).max(axis=0)
    fast = np.abs(np.gradient(x, 0.01, axis=0)).max(axis=0)
    q: Array = centre + (at(times) - middle) * np.minimum(reach / wide, speed / fast)
    return q


def ordinary(rng: Numbers, kind: str, span: tuple[Array, Array, Array], times: Array) -> Array:
    """Angles (N, 3) of ordinary work. kind: one of ORDINARY; before time 0 the arm waits."""
    centre, reach, speed = span
    if kind == "sweep":
        end = float(times[-1])
        t = np.maximum(times, 0.0)[:, None]
        low, high = rng.uniform(0.03, 0.06, (3, 2)), rng.uniform(0.2, 0.35, (3, 2))
        weight = np.stack([rng.uniform(0.5, 0.8, 3)] * 2, axis=1) * [1.0, 0.25]
        phase = 2 * np.pi * (low * t[..., None] + (high - low) * t[..., None] ** 2 / (2 * end))
        swept: Array = centre + reach * (weight * np.sin(phase)).sum(axis=2)
        return swept
    q = np.empty((len(times), 3))
    here, k = centre.copy(), int(np.searchsorted(times, 0.0))
    q[:k] = here
    one = 0
    while k < len(times):
        there = centre + reach * rng.uniform(-1, 1, 3)
        if kind == "jogging":
            moved = rng.random(3) < 0.3
            moved[one % 3], one = True, one + 1
            there = np.where(moved, there, here)
        way = np.abs(there - here)
        slow = rng.uniform(0.3, 1.0)
        seconds = max(float((way / speed).max()) * 1.9 / slow, 0.2)
        steps = int(seconds / TICK)
        u = np.arange(1, steps + 1) / steps
        if kind == "jogging":  # speed as a trapezium, a quarter of the time for each flank
            s = np.where(
                u < 0.25, u**2 / 0.375, np.where(u > 0.75, 1 - (1 - u) ** 2 / 0.375, (u - 0.125) / 0.75)
            )
        else:
            s = u**3 * (10 - 15 * u + 6 * u**2)
        part = here + s[:, None] * (there - here)
        pause = int(rng.uniform(0.2, 1.0) / TICK)
        part = np.concatenate([part, np.repeat(there[None], pause, axis=0)])[: len(times) - k]
        q[k : k + len(part)] = part
        k += len(part)
        here = there
    return q
