"""Samples at rest: friction is undetermined there, and what is made of them breeds false causes."""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from modelgen.dataset.processing.decimation import kept
from modelgen.dataset.processing.settings import Chosen
from modelgen.numeric import Array


def moving_samples(dq: Array, rows: np.ndarray, settings: Chosen, rate: float) -> np.ndarray:
    """Whether each joint moves at the rows (M, n), given its speeds dq (N, n).

    A joint is at rest where it is slower than its rest speed for longer than `settings.rest_time`; a
    reversal passes faster. A row counts as moving where its own speed is above that and the parallel filter
    has drawn no more than a fiftieth of its weight from samples at rest.
    """
    slow = np.abs(dq) < np.array(settings.rest_speeds)
    rest = _resting(slow, settings.rest_time * rate)
    moving = ~slow[rows]
    resting = np.flatnonzero(rest.any(axis=0))
    if len(resting):
        flags = rest[:, resting].astype(np.float64)
        weight = kept(flags, rows, settings.cutoff, rate, settings.order)
        moving[:, resting] &= weight < settings.thresholds.max_rest_weight
    return np.asarray(moving)


def samples_away_from_rest(dq: Array, settings: Chosen, rate: float) -> np.ndarray:
    """Samples (N, n) where the joint does not rest, be it for a moment, nor stops or starts, for longer, so
    near that the filters of its position blend both.
    """
    slow = np.abs(dq) < np.array(settings.rest_speeds)
    moment, reach = settings.rest_time, settings.half_width
    if settings.cutoff:
        moment = min(moment, settings.thresholds.short_rest_cutoff_periods / settings.cutoff)
    if settings.position_cutoff:
        reach += round(0.5 * rate / settings.position_cutoff)
    long = ndimage.binary_dilation(_resting(slow, settings.rest_time * rate), np.ones((2 * reach + 1, 1)))
    return np.asarray(~long & ~_resting(slow, moment * rate))


def directed(dq: Array, noise: tuple[float, ...], within: float) -> np.ndarray:
    """Samples (N, n) where the direction of speeds (N, n) is known.

    noise: speeds (n,) that the rounding of the positions may feign. within: sampling periods to which the
    instants of the efforts beside are known; the joint turned back earlier or comes to it later.
    """
    if len(dq) < 2:
        return np.ones(dq.shape, dtype=bool)
    return np.asarray(np.abs(dq) >= np.maximum(noise, within * np.abs(np.gradient(dq, axis=0))))


def beside_turns(dq: Array, within: float, apart: int) -> np.ndarray:
    """Samples (N, n) that lie `within` sampling periods of an instant at which a joint turns back, as its
    acceleration has it: one that sticks for some time is near it for longer.

    dq: speeds (N, n). apart: samples between two turns, at least; speeds most of whose changes of sign lie
    nearer to each other have them by their noise, and say nothing of turns.
    """
    if len(dq) < 2 or not within:
        return np.zeros(dq.shape, dtype=bool)
    turned = np.zeros(dq.shape)
    turned[1:] = dq[1:] * dq[:-1] <= 0.0
    around = ndimage.convolve1d(turned, np.ones(2 * apart + 1), axis=0, mode="constant")
    alone = (turned > 0.0) & (around < 1.5)
    seen = 2.0 * alone.sum(axis=0) >= turned.sum(axis=0)
    return np.asarray(seen & (np.abs(dq) < within * np.abs(np.gradient(dq, axis=0))))


def weights(flags: np.ndarray, settings: Chosen, rate: float) -> Array:
    """Weights (N, n) of samples by which columns are multiplied before a filter: 0 where flags (N, n) are not
    set, 1 away from there.

    Accelerations carry most of their noise near the cut-off of the positions, and sharp edges of what is left
    out mix it down into the band of the equations. Where it is large, edges are as long as a period there, a
    Hann window laid inside: less than half of that comes down. Longer ones would cost more of the motion than
    they bring, and so would any where there is little noise.
    """
    if flags.all():
        return np.ones(flags.shape)
    half = round(0.5 * rate * settings.edge)
    if not half:
        return flags.astype(np.float64)
    window = np.hanning(2 * half + 3)[1:-1, None]
    inside = ndimage.binary_erosion(flags, np.ones((2 * half + 1, 1)), border_value=1)
    return np.asarray(ndimage.convolve(inside.astype(np.float64), window / window.sum(), mode="nearest"))


def _resting(slow: np.ndarray, longest: float) -> np.ndarray:
    """Flags (N, n) of slow samples, in runs of `longest` samples or more."""
    return np.stack([long_runs(column, max(2, round(longest))) for column in slow.T], axis=1)


def long_runs(flags: np.ndarray, longest: int) -> np.ndarray:
    """The flags (N,), without runs of True shorter than `longest`."""
    kept = np.zeros(len(flags), dtype=bool)
    for begin, end in runs(flags):
        if end - begin >= longest:
            kept[begin:end] = True
    return kept


def runs(flags: np.ndarray) -> np.ndarray:
    """Samples (K, 2) at which runs of True in flags (N,) begin, and those after their last ones."""
    return np.flatnonzero(np.diff(np.concatenate(([0], flags.astype(np.int8), [0])))).reshape(-1, 2)
