"""Delays of the inputs, of one joint or of all."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from modelgen.description.objects import Arm
from modelgen.effects import CATALOGUE, AppliedEffect
from modelgen.numeric import Array


def acting(arm: Arm, t: Array, given: Array) -> Array:
    """Inputs (N, n) given at times t (N,) [s] as they act on an arm whose own inputs are delayed."""
    uses = [(u, list(range(given.shape[1]))) for u in arm.effects]
    uses += [(u, [n]) for n, i in enumerate(arm.coordinates) for u in arm.joints[i].effects]
    for use, columns in uses:
        delay = CATALOGUE[use.name].delays(use.values)
        if delay is not None:  # what was commanded a delay ago acts now
            given = given.copy()
            for k in columns:
                given[:, k] = np.interp(t - delay, t, given[:, k])
    return given


def added(t: Array, now: Array, delay: float, joint: int | None) -> Array:
    """Change of inputs (N, n) by a delay [s] of coordinate `joint` (from 1), None: of all."""
    later = np.column_stack([np.interp(t + delay, t, x) for x in now.T]) - now
    if joint is not None:
        later[:, [k for k in range(now.shape[1]) if k != joint - 1]] = 0.0
    return later


def undone(effects: Sequence[AppliedEffect], arm: Arm, names: Sequence[str], given: Array) -> Array:
    """States (N, s), by `names`, in which inputs (N, n) that `acting` has shifted are not delayed again."""
    states = np.zeros((len(given), max(1, len(names))))
    for e in effects:
        values = dict.fromkeys((p.name for p in e.effect.nonlinear), 0.0)
        for symbol in e.states.values() if e.effect.delays(values) is not None else []:
            assert e.joint is not None
            states[:, names.index(symbol.name)] = given[:, arm.coordinates.index(e.joint)]
    return states
