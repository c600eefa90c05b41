"""A record simulated in many short windows at once, each from its measured state with the measured inputs.

Short windows (multiple shooting; Bock 1983) keep an arm without a controller comparable with its log. Fixed
steps of the record's period for all windows together: `modelgen.simulation.replay` steps as finely as one
simulation asks for, and takes that long.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from modelgen.backends import NumpyFunction
from modelgen.dataset import Prepared
from modelgen.functions import Model
from modelgen.simulation.metrics import Scores, scores

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Windows(Scores):
    """t: (W, S) [s]; simulated, measured: (W, S, n) [rad, m], without windows that left their bounds."""

    t: Array
    simulated: Array
    measured: Array


def simulated_windows(
    model: Model, parameters: Array, states: Array | None, prepared: Prepared, starts: Array, length: int
) -> Windows | None:
    """Windows of `length` samples that begin at the samples `starts` (W,); None where nothing stays finite.

    By the midpoint rule, all windows at once. parameters: base parameters (p,). states: of the effects at
    every sample of the record (N, s), as the measured motion has brought them there.
    """
    with np.errstate(invalid="ignore", over="ignore"):  # of those that leave their bounds
        path = _path(model, parameters, states, prepared, starts, length)
    good = np.isfinite(path).all(axis=(1, 2))
    if not good.any():
        return None
    measured = np.stack([prepared.q[s : s + length] for s in starts])[good]
    t = np.stack([prepared.time[s : s + length] for s in starts])[good]
    found = scores(measured, path[good])
    return Windows(found.f_gof, found.mae, found.rmse, t, path[good], measured)


def _path(
    model: Model, parameters: Array, states: Array | None, p: Prepared, starts: Array, length: int
) -> Array:
    """Positions (W, length, n)."""
    step = p.record.step
    made = {
        f.name: NumpyFunction(f) for f in model.functions if f.name in ("forward_dynamics", "effects_step")
    }
    forward, stepped = made["forward_dynamics"], made.get("effects_step")
    q, dq = p.q[starts].copy(), p.dq[starts].copy()
    state = np.zeros((len(starts), max(1, len(model.states)))) if states is None else states[starts]
    inputs = np.zeros(p.q.shape) if p.input is None else p.input
    ddq = np.zeros(q.shape)
    path = np.empty((len(starts), length, q.shape[1]))

    def given(call: NumpyFunction, q: Array, dq: Array, k: int) -> dict[str, Array]:
        known = {
            "q": q,
            "dq": dq,
            "ddq": ddq,
            "input": inputs[starts + k],
            "parameters": parameters,
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
