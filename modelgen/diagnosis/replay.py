"""A record simulated: in windows from their measured initial states with the measured inputs, or as a whole.

Short windows (multiple shooting) keep an arm without a controller comparable with its log. A free motion
has no inputs, and is simulated from its beginning to its end.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modelgen.backends import NumpyFunction
from modelgen.diagnosis.outcome import Fitted
from modelgen.diagnosis.rows import Array, Rows
from modelgen.probing import Prober

WINDOW = 0.25  # s
MOST = 250  # windows


@dataclass(frozen=True)
class Scores:
    """Of simulated against measured motion, by joint (n,): F_gof [%], MAE and RMSE [rad, m].

    t: (W, S) [s] of the windows; simulated, measured: (W, S, n), without windows that left their bounds.
    """

    f_gof: Array
    mae: Array
    rmse: Array
    t: Array
    simulated: Array
    measured: Array


def replay(fitted: Fitted, rows: Rows) -> Scores | None:
    """Simulated against measured positions; None where the record is too short, or nothing stays finite.

    Fixed steps of the record's period by the midpoint rule, all windows at once. States of effects begin as
    the measured motion has brought them there.
    """
    p = rows.prepared
    step, trim = p.record.step, int(p.rows[0])
    if p.input is None:
        moving = np.flatnonzero(rows.moving.any(axis=1))
        if not len(moving):
            return None
        starts = p.rows[moving[:1]]
        length = len(p.time) - trim - int(starts[0])
    else:
        length = max(4, round(WINDOW / step))
        count = (len(p.time) - 2 * trim) // length
        if count < 2:
            return None
        starts = trim + length * np.linspace(0, count - 1, min(count, MOST)).astype(int)
    path = _path(fitted, rows, starts, length)
    good = np.isfinite(path).all(axis=(1, 2))
    if not good.any():
        return None
    measured = np.stack([p.q[s : s + length] for s in starts])[good]
    error = path[good] - measured
    spread = measured - measured.mean(axis=(0, 1))
    f_gof = 100 * (1 - np.sqrt((error**2).sum(axis=(0, 1)) / (spread**2).sum(axis=(0, 1))))
    t = np.stack([p.time[s : s + length] for s in starts])[good]
    mae, rmse = np.abs(error).mean(axis=(0, 1)), np.sqrt((error**2).mean(axis=(0, 1)))
    return Scores(f_gof, mae, rmse, t, path[good], measured)


def _path(fitted: Fitted, rows: Rows, starts: Array, length: int) -> Array:
    """Positions (W, length, n) of windows that begin at the samples `starts`."""
    p, step = rows.prepared, rows.prepared.record.step
    made = {
        f.name: NumpyFunction(f)
        for f in fitted.model.functions
        if f.name in ("forward_dynamics", "effects_step")
    }
    forward, stepped = made["forward_dynamics"], made.get("effects_step")
    q, dq = p.q[starts].copy(), p.dq[starts].copy()
    state = np.zeros((len(starts), max(1, len(fitted.model.states))))
    if stepped is not None:
        prober = Prober(fitted.arm)
        state = prober.states(rows.motion, fitted.parameters)[starts]
    inputs = np.zeros(p.q.shape) if p.input is None else p.input
    ddq = np.zeros(q.shape)
    path = np.empty((len(starts), length, q.shape[1]))

    def given(call: NumpyFunction, q: Array, dq: Array, k: int) -> dict[str, Array]:
        known = {
            "q": q,
            "dq": dq,
            "ddq": ddq,
            "input": inputs[starts + k],
            "parameters": fitted.parameters,
            "time": p.time[starts + k][:, None],
            "state": state,
            "dt": np.full((len(starts), 1), step),
        }
        return {a.name: known[a.name] for a in call.function.arguments}

    for k in range(length):
        path[:, k] = q
        ddq = np.asarray(forward(**given(forward, q, dq, k)))
        half = dq + step / 2 * ddq
        middle = np.asarray(forward(**given(forward, q + step / 2 * dq, half, k)))
        if stepped is not None:
            state = np.asarray(stepped(**given(stepped, q, dq, k)))
        q, dq = q + step * half, dq + step * middle
    return path
