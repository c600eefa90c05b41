"""The state from which a free motion begins, as the model sees it in the first second of the record.

Nothing drives a free motion after its start, so an error there lasts: what a filter knows of the speed at the
release leaves several times the positions' noise in a motion that is right. Over the whole record, the start
would make up for what a wrong model does later.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from modelgen.numeric import Array

# Budgets of the fit: how finely it ends decides nothing.
ROUNDS = 8
HALVINGS = 5
LEAST_GAIN = 1e-3  # of the squared errors, beneath which a step is the last
SPAN = 1.0  # s of the motion by which its start is fitted
FEWEST = 10  # samples of it
TOUCH = 1e-3  # of a coordinate's range, by which a start is moved to see what that changes

# From starts q, dq (W, n) over so many samples: positions (W, samples, n), NaN where none ran.
Motions = Callable[[Array, Array, int], Array]


def nearest_start(motions: Motions, measured: Array, step: float, q: Array, dq: Array) -> tuple[Array, Array]:
    """Positions and speeds (n,) from which the motion comes nearest to the measured one, (S, n), in its first
    second.

    Gauss's and Newton's steps from q, dq (n,), halved while they bring nothing; the errors of a joint are
    weighed by those of the first motion. step: the record's [s]. Where no motion near runs, q and dq.
    """
    n = len(q)
    measured = measured[: max(FEWEST, round(SPAN / step))]
    reach = TOUCH * np.maximum(np.ptp(measured, axis=0), 1e-9)
    fast = TOUCH * np.maximum(np.ptp(np.diff(measured, axis=0), axis=0) / step, 1e-9)
    moves = np.diag(np.concatenate([reach, fast]))
    start = np.concatenate([q, dq])

    def errors(starts: Array) -> Array:
        return np.asarray(measured - motions(starts[:, :n], starts[:, n:], len(measured)))

    (first,) = errors(start[None])
    if not np.isfinite(first).all():
        return q, dq
    weights = 1.0 / np.maximum(np.sqrt((first**2).mean(axis=0)), 1e-12)
    least = float(((first * weights) ** 2).sum())
    for _ in range(ROUNDS):
        around = (errors(start + np.concatenate([np.zeros((1, 2 * n)), moves])) * weights).reshape(
            2 * n + 1, -1
        )
        if not np.isfinite(around).all():
            break
        columns = (around[0] - around[1:]).T  # errors fall by these
        change = np.linalg.lstsq(columns, around[0], rcond=1e-9)[0] @ moves
        for half in range(HALVINGS):
            tried = start + change / 2**half
            value = float(((errors(tried[None])[0] * weights) ** 2).sum())
            if value < least:
                break
        else:
            break
        gained, start, least = 1.0 - value / least, tried, value
        if gained < LEAST_GAIN:
            break
    return start[:n], start[n:]
