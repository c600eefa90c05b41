"""Samples at rest: friction is undetermined there, and what is made of them breeds false causes."""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from modelgen.dataset.choice import Chosen
from modelgen.dataset.decimation import kept
from modelgen.dataset.objects import Array

SHARE = 0.02  # of the filter's weight that may lie on samples at rest
SHORT = 0.05  # of a period of the cut-off: a rest that leaves something, and a joint that sticks for a moment


def moving_samples(dq: Array, rows: np.ndarray, settings: Chosen, rate: float) -> np.ndarray:
    """Whether each joint moves at the rows (M, n), given its speeds dq (N, n).

    A joint is at rest where its speed stays below its gate for longer than `settings.rest_time`; a reversal
    passes faster. A row counts as moving where its own speed is above the gate and the parallel filter has
    taken no more than a fiftieth of its weight from samples at rest.
    """
    longest = max(2, round(settings.rest_time * rate))
    return _away(dq, rows, settings, rate, longest)[0]


def samples_far_from_rest(dq: Array, rows: np.ndarray, settings: Chosen, rate: float) -> np.ndarray:
    """The same where the filter carries next to nothing from any rest: what sticks for a moment only counts
    as resting, and so does negative weight, by which the filter swings before and after.
    """
    if not settings.cutoff:
        return moving_samples(dq, rows, settings, rate)
    moving, share = _away(dq, rows, settings, rate, _moment(settings, rate))
    return np.asarray(moving & (share > -SHARE))


def samples_away_from_rest(dq: Array, settings: Chosen, rate: float) -> np.ndarray:
    """Samples (N, n) where the joint does not rest, be it for a moment, nor stops or starts so near that the
    filters of its position blend both.
    """
    reach = settings.half_width
    if settings.position_cutoff:
        reach += round(0.5 * rate / settings.position_cutoff)
    rest = _resting(np.abs(dq) < np.array(settings.gates), _moment(settings, rate))
    return np.asarray(~ndimage.binary_dilation(rest, np.ones((2 * reach + 1, 1))))


def _moment(settings: Chosen, rate: float) -> int:
    """Samples of the shortest rest that leaves something in what the parallel filter lets pass."""
    longest = settings.rest_time
    if settings.cutoff:
        longest = min(longest, SHORT / settings.cutoff)
    return max(2, round(longest * rate))


def _away(
    dq: Array, rows: np.ndarray, settings: Chosen, rate: float, longest: int
) -> tuple[np.ndarray, np.ndarray]:
    """Whether the rows are away from rests of so many samples, and their share of the filter (M, n)."""
    slow = np.abs(dq) < np.array(settings.gates)
    rest = _resting(slow, longest)
    share = np.zeros((len(rows), dq.shape[1]))
    resting = np.flatnonzero(rest.any(axis=0))
    if len(resting):
        flags = rest[:, resting].astype(np.float64)
        share[:, resting] = kept(flags, rows, settings.cutoff, rate, settings.order)
    return np.asarray(~slow[rows] & (share < SHARE)), share


def _resting(slow: np.ndarray, longest: int) -> np.ndarray:
    return np.stack([long_runs(column, longest) for column in slow.T], axis=1)


def long_runs(flags: np.ndarray, longest: int) -> np.ndarray:
    """The flags (N,), without runs of True shorter than `longest`."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], flags.astype(np.int8), [0]))))
    kept = np.zeros(len(flags), dtype=bool)
    for begin, end in edges.reshape(-1, 2):
        if end - begin >= longest:
            kept[begin:end] = True
    return kept
