"""Positions that jump as no motion does: an encoder that starts anew or slips, readings that are missing."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from modelgen.dataset.objects import Record
from modelgen.dataset.processing.rounding import step_of
from modelgen.dataset.thresholds import DatasetThresholds
from modelgen.errors import InputError
from modelgen.numeric import Array

BESIDE = 3  # steps on either side, to which one is compared
LIKE = 3  # of them, that a motion has as large: two may be jumps of their own
USUAL = 0.9  # quantile of the steps that are not zero
ROUNDED = 4.0  # of the resolution, that rounding may make of the steps of a slow motion


def jump_of(names: tuple[str, ...], t: Array, columns: Array, limits: DatasetThresholds) -> str:
    """What there is to say where a position (N, n) jumps from one stamp t (N,) [s] to the next; else empty.

    A single reading far from those beside it is corrected before.
    """
    for name, values in zip(names, columns.T, strict=True):
        found, usual = jumps(t, values, limits)
        if not len(found):
            continue
        k = int(found[0])
        more = f", and so in {len(found) - 1} more places" if len(found) > 1 else ""
        return (
            f"{name} jumps by {values[k + 1] - values[k]:.4g} after t = {t[k]:.9g} s, where its usual steps "
            f"are {usual:.2g}{more}: readings are missing, stood still, or the encoder starts anew there, "
            "which `wrap` in a mapping file (--mapping) declares; else use the parts beside it, FILE@t0:t1"
        )
    return ""


def check_jumps(records: Iterable[Record]) -> None:
    """No record in which a position jumps: nothing is identified across that. Raises InputError."""
    for record in records:
        if record.jump:
            raise InputError(f"{record.name}: {record.jump}")


def jumps(t: Array, values: Array, limits: DatasetThresholds) -> tuple[NDArray[np.intp], float]:
    """Samples after which positions (N,) jump, and the size of the usual steps.

    A step counts by its speed where samples are missing, over the longest of three times since a late stamp
    may go with the reading before. It is a jump where it is many times the usual ones, and hardly one of
    those beside it is near as large: of a fast motion they are.
    """
    nothing = np.empty(0, dtype=np.intp), 0.0
    if len(values) < limits.min_lone_samples:
        return nothing
    period = np.diff(t)
    typical = float(np.median(period))
    longest = np.lib.stride_tricks.sliding_window_view(np.pad(period, 1), 3).max(axis=1)
    size = np.abs(np.diff(values)) * typical / np.maximum(longest, max(typical, 1e-300))
    moved = size[size > 0.0]
    if not len(moved):
        return nothing
    usual = float(np.quantile(moved, USUAL))
    large = np.flatnonzero(size > limits.jump * usual)
    if not len(large):
        return nothing
    padded = np.pad(size, BESIDE)
    window = np.lib.stride_tricks.sliding_window_view(padded, 2 * BESIDE + 1)[large]
    beside = np.sort(np.delete(window, BESIDE, axis=1), axis=1)[:, -LIKE]
    step = step_of(values)
    found = size[large] > limits.jump * np.maximum(beside, ROUNDED / limits.jump * step)
    return large[found], usual
