"""Rows of several sources in turn: each channel has its own instants, and is blank at the others'."""

from __future__ import annotations

import numpy as np

from modelgen.dataset.thresholds import USUAL
from modelgen.errors import InputError
from modelgen.numeric import Array

BURSTS = 0.2  # of the mean time between readings, below which the usual one says that they come in bursts


def in_turn(file: str, names: tuple[str, ...], table: Array) -> tuple[Array, str]:
    """Columns (N, k), blank where NaN, at the instants of the first of them after the time; a remark.

    The others are interpolated by straight lines, where they have begun and not ended. Raises InputError
    where a channel is blank for longer than a gap may last.
    """
    t = table[:, 0]
    if np.isnan(t).any():
        raise InputError(
            f"{file}: the time column {names[0]} is blank in row {int(np.argmax(np.isnan(t))) + 1}"
        )
    filled = ~np.isnan(table)
    empty = next((name for name, there in zip(names, filled.T, strict=True) if there.sum() < 2), None)
    if empty is not None:
        raise InputError(f"{file}: the column {empty} holds no readings")
    base = filled[:, min(1, len(names) - 1)].copy()
    chosen = t[base]
    for k in range(1, len(names)):
        stamps = t[filled[:, k]]
        inside = (chosen >= stamps[0]) & (chosen <= stamps[-1])
        steps = np.diff(stamps)
        longest = USUAL.max_gap_periods * float(np.median(steps))
        if len(steps) and steps.max() > longest:
            at = stamps[int(np.argmax(steps))]
            if np.median(steps) < BURSTS * np.mean(steps):
                raise InputError(
                    f"{file}: the stamps of the column {names[k]} come in bursts, most "
                    f"{np.median(steps):.3g} s apart, up to {steps.max():.4g} s: expected each row at "
                    "the time at which it was read, or all columns in every row"
                )
            raise InputError(
                f"{file}: the column {names[k]} is blank for {steps.max():.4g} s after t = {at:.9g}, "
                f"expected a reading every {np.median(steps):.4g} s"
            )
        base[base] = inside
        chosen = t[base]
    result = np.empty((len(chosen), len(names)))
    result[:, 0] = chosen
    for k in range(1, len(names)):
        there = filled[:, k]
        result[:, k] = np.interp(chosen, t[there], table[there, k])
    own = [name for name, there in zip(names, filled.T, strict=True) if not there[base].all()]
    if not own:
        short = ", ".join(name for name, there in zip(names, filled.T, strict=True) if not there.all())
        return result, f"{len(t) - len(chosen)} rows are left out, for they are without {short}"
    listed = ", ".join(own)
    at = names[min(1, len(names) - 1)]
    return result, f"rows come in turn: {listed} interpolated by straight lines at the instants of {at}"
