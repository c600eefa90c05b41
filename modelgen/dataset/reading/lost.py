"""Rows that are missing although the stamps are even: a row's number as time, a logger that stamps anew."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset.processing.rounding import step_of
from modelgen.dataset.thresholds import DatasetThresholds
from modelgen.numeric import Array

BESIDE = 8  # steps on either side, whose median says what a step is there
STAYING = 3  # steps on either side, over which the positions stay ahead
SEEN = 4.0  # deviations of its noise, that a step of all positions is large, to tell it from two
NEAR = 0.3  # steps, by which a number of them may miss a whole one
ALONE = 0.5  # of a step, by which one is ahead of either next to it
ENOUGH = 1024  # steps, that noise is read off
FEWEST = 5  # places, from which on rows are missing
CLEARLY = 5.0  # times the places at which the positions fall behind in the same way, as noise has both
REMARKED = 1e-3  # of the rows: the motion seems so much faster, and inertias lose twice that
RESTORED = 5e-3  # of the rows, up to which those found are all but all there are


class Missing(NamedTuple):
    """places: samples (M,) after which rows are missing. rows: how many there (M,). share: of all rows."""

    places: NDArray[np.intp]
    rows: NDArray[np.intp]
    share: float


def lost_rows(t: Array, missing: Missing) -> str:
    """What there is to say of rows that are missing between even stamps t (N,) [s], else empty."""
    if missing.share < REMARKED:
        return ""
    return f"{_so_many(t, missing)}; expected stamps of the readings' own clock, or a log without losses"


def at_their_instants(t: Array, missing: Missing) -> tuple[Array, str]:
    """Even stamps t (N,) [s], later by the rows that are missing before them, and a remark; unchanged where
    none are, or so many that those between, which nobody sees, would count.
    """
    if not len(missing.places) or missing.share > RESTORED:
        return t, ""
    later = np.zeros(len(t))
    np.add.at(later, missing.places + 1, missing.rows)
    said = f"{_so_many(t, missing)}; what follows counts as so much later"
    return t + float(np.median(np.diff(t))) * np.cumsum(later), said


def _so_many(t: Array, missing: Missing) -> str:
    return (
        f"{100 * missing.share:.2g} % of the rows or so are missing though the stamps are even: after "
        f"t = {t[missing.places[0]]:.9g} s and in {len(missing.places) - 1} more places the positions go on "
        "by two or more of the steps beside"
    )


def missing_rows(positions: Array, limits: DatasetThresholds) -> Missing:
    """Where rows are missing by positions (N, n), as logged, that have even stamps; none where they are few.

    Where rows are missing all joints go on by a whole number of the steps beside, and stay ahead. A reading
    that is late, stands still or is noisy gives back what it took. Where the joints are so slow that a step
    vanishes in noise nobody sees it: there as many are missing as elsewhere.
    """
    nothing = Missing(np.empty(0, dtype=np.intp), np.empty(0, dtype=np.intp), 0.0)
    if len(positions) < limits.min_lone_samples:
        return nothing
    steps, wide = np.diff(positions, axis=0), 2 * BESIDE + 1
    window = np.lib.stride_tricks.sliding_window_view(steps, wide, axis=0)
    here, some = steps[BESIDE:-BESIDE], slice(None, None, 1 + len(steps) // ENOUGH)
    beside = np.median(window[some], axis=2)
    apart = np.abs(here[some] - beside)
    least = np.min(np.where(apart > 1e-9 * np.abs(steps).max(axis=0), apart, np.inf), axis=0)
    noise = np.maximum(1.4826 * np.median(apart, axis=0), np.where(np.isfinite(least), least / 4, 0.0))
    # The mean has the missing rows in it: a first look, which leaves few places.
    first, seen = _ahead(here, (positions[wide:] - positions[:-wide]) / wide, noise, SEEN / 2)
    near = np.flatnonzero(seen & (np.abs(first) > NEAR / 2))
    if len(near) < FEWEST:
        return nothing
    counts = np.array([step_of(x) for x in positions.T])
    noise = np.maximum(noise, counts / np.sqrt(6.0))
    usual, seen = _ahead(here[some], beside, noise, SEEN)
    if not seen.any() or 1.4826 * np.median(np.abs(usual[seen])) > 1.0 / SEEN:
        return nothing  # they vary by parts of a step, as where the readings' instants do
    part = float(seen.mean())
    window = window[near]
    beside = _usual(np.delete(window, BESIDE, axis=2), noise)
    around = window[:, :, BESIDE - STAYING : BESIDE + STAYING + 1].sum(axis=2)
    ahead, seen = _ahead(here[near], beside, noise, SEEN)
    stays, _ = _ahead(around - 2 * STAYING * beside, beside, noise, SEEN)
    # Steps of a short move differ from those around it, and not from both next to it.
    alone = [_ahead(here[near], window[:, :, BESIDE + way], noise, 0.0)[0] for way in (-1, 1)]
    found, fallen = _whole(ahead, stays) & seen, _whole(-ahead, -stays) & seen
    found &= np.minimum(*alone) > ALONE
    fallen &= np.maximum(*alone) < -ALONE
    if found.sum() < max(FEWEST, CLEARLY * fallen.sum()):
        return nothing
    # In a short move the steps next to it say better than those around it how large one is.
    rows = np.rint(np.median([ahead, *alone], axis=0)[found]).astype(np.intp)
    return Missing(near[found] + BESIDE, rows, float(rows.sum() / (part * len(steps) + rows.sum())))


def _usual(window: Array, noise: Array) -> Array:
    """The step (M, n) that those of a window (M, n, K) have in common, to parts of a count: the mean of those
    about their median, without what is ahead by a step.
    """
    middle = np.median(window, axis=2, keepdims=True)
    apart, spread = np.abs(window - middle), NEAR * np.abs(middle) + 2.0 * noise[:, None]
    near = apart <= np.maximum(spread, np.min(apart, axis=2, keepdims=True))
    return np.asarray(np.sum(window, axis=2, where=near) / np.sum(near, axis=2))


def _ahead(here: Array, beside: Array, noise: Array, least: float) -> tuple[Array, NDArray[np.bool_]]:
    """How many of the steps beside (M, n) the steps here are ahead of one, by all joints (M,), and where it
    shows: those beside are `least` deviations (n,) of their noise large.
    """
    weights = beside / np.where(noise > 0.0, noise, np.inf) ** 2
    power = np.einsum("kj,kj->k", weights, beside)
    seen = power > least**2
    return np.einsum("kj,kj->k", weights, here) / np.where(seen, power, np.inf) - seen, seen


def _whole(ahead: Array, stays: Array) -> NDArray[np.bool_]:
    """Where positions go on by whole steps more than those beside (M,), and are so far ahead then."""
    number, later = np.rint(ahead), np.rint(stays)
    near = (np.abs(ahead - number) < NEAR) & (np.abs(stays - later) < NEAR)
    return near & (number >= 1.0) & (later >= number)
