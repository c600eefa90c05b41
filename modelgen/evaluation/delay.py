"""Delays of the inputs, of one joint or of all."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.signal import lfilter

from modelgen.description.objects import Arm
from modelgen.effects import CATALOGUE, AppliedEffect
from modelgen.numeric import Array


def acting(arm: Arm, t: Array, given: Array) -> Array:
    """Inputs (N, n) given at times t (N,) [s] as they act on an arm whose own inputs are delayed."""
    uses = [(u, list(range(given.shape[1]))) for u in arm.effects]
    uses += [(u, [n]) for n, i in enumerate(arm.coordinates) for u in arm.joints[i].effects]
    for use, columns in uses:
        definition = CATALOGUE[use.name]
        delay = definition.delays(use.values)
        if delay is not None:  # what was commanded a delay ago acts now
            given = given.copy()
            given[:, columns] = shifted(t, given[:, columns], -delay, lags=definition.lags(use.values))
    return given


def added(t: Array, now: Array, delay: float, joint: int | None, lags: bool = False) -> Array:
    """Change of inputs (N, n) by a delay [s] of coordinate `joint` (from 1), None: of all.

    lags: whether it is the time constant of a lag.
    """
    later = shifted(t, now, delay, lags=lags) - now
    if joint is not None:
        later[:, [k for k in range(now.shape[1]) if k != joint - 1]] = 0.0
    return later


def shifted(t: Array, now: Array, ahead: float, *, lags: bool) -> Array:
    """Signals (N, n) at times t (N,), evenly spaced, as they are `ahead` [s] later.

    lags: what a first-order lag with that time constant must be given to make them; with a negative one, what
    the lag makes of them. It begins at rest, and takes its input for straight between samples.
    """
    if not lags:
        return np.column_stack([np.interp(t + ahead, t, x) for x in now.T])
    step = (t[-1] - t[0]) / (len(t) - 1)
    if ahead >= 0.0:
        return np.asarray(now + ahead * np.gradient(now, step, axis=0))
    kept = float(np.exp(step / ahead))
    slope = (1.0 - kept) * -ahead / step
    weights = [1.0 - slope, slope - kept]
    # At rest before the first sample: there the output is the input.
    begun = now[:1] * slope
    return np.asarray(lfilter(weights, [1.0, -kept], now, axis=0, zi=begun)[0])


def undone(effects: Sequence[AppliedEffect], arm: Arm, names: Sequence[str], given: Array) -> Array:
    """States (N, s), by `names`, in which inputs (N, n) that `acting` has shifted are not delayed again."""
    states = np.zeros((len(given), max(1, len(names))))
    for e in effects:
        values = dict.fromkeys((p.name for p in e.effect.nonlinear), 0.0)
        for symbol in e.states.values() if e.effect.delays(values) is not None else []:
            assert e.joint is not None
            states[:, names.index(symbol.name)] = given[:, arm.coordinates.index(e.joint)]
    return states
