"""A record simulated in many short windows at once, each from its measured state with the measured inputs;
a free motion as a whole, from the start that fits it.

Short windows (multiple shooting; Bock 1983) keep an arm without a controller comparable with its log. Fixed
steps for all windows together: `modelgen.simulation.replay` steps as finely as one simulation asks for, and
takes that long.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from modelgen.backends import NumpyFunction
from modelgen.dataset import Prepared
from modelgen.functions import Model
from modelgen.numeric import Array
from modelgen.simulation.metrics import Scores, scores
from modelgen.simulation.start import nearest_start

FINE = 5e-4  # s, longest step where effects have states: a drive before an elastic joint is light
# s, longest step of a whole free motion: by the midpoint rule a swing of angular frequency w is late by the
# phase w^3 h^2 t / 24 after the time t, in short windows next to nothing.
FREE = 2.5e-3


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

    By the midpoint rule, all windows at once, states of effects half a step ahead of the motion (leapfrog).
    parameters: base parameters (p,). states: at every sample of the record (N, s), as the measured motion has
    brought them there.
    """
    p = prepared
    return _scored(_path(model, parameters, states, p, starts, length, p.q[starts], p.dq[starts]), p, starts)


def simulated_release(
    model: Model, parameters: Array, states: Array | None, prepared: Prepared, begin: int, length: int
) -> Windows | None:
    """The free motion of `length` samples from the sample `begin` on, as `simulated_windows` has it, from the
    start that brings it nearest to the measured one.
    """
    p = prepared

    def motions(q: Array, dq: Array, samples: int) -> Array:
        return _path(model, parameters, states, p, np.full(len(q), begin), samples, q, dq)

    measured = p.q[begin : begin + length]
    q, dq = nearest_start(motions, measured, p.record.step, p.q[begin], p.dq[begin])
    return _scored(motions(q[None], dq[None], length), p, np.array([begin]))


def _scored(path: Array, prepared: Prepared, starts: Array) -> Windows | None:
    length = path.shape[1]
    good = np.isfinite(path).all(axis=(1, 2))
    if not good.any():
        return None
    measured = np.stack([prepared.q[s : s + length] for s in starts])[good]
    t = np.stack([prepared.time[s : s + length] for s in starts])[good]
    found = scores(measured, path[good])
    return Windows(found.f_gof, found.mae, found.rmse, t, path[good], measured)


@np.errstate(invalid="ignore", over="ignore")
def _path(
    model: Model,
    parameters: Array,
    states: Array | None,
    p: Prepared,
    starts: Array,
    length: int,
    q: Array,
    dq: Array,
) -> Array:
    """Positions (W, length, n) from q, dq (W, n) at the samples `starts`; not finite where they run away."""
    made = {
        f.name: NumpyFunction(f) for f in model.functions if f.name in ("forward_dynamics", "effects_step")
    }
    forward, stepped = made["forward_dynamics"], made.get("effects_step")
    longest = FINE if stepped is not None else FREE if p.input is None else p.record.step
    substeps = math.ceil(p.record.step / longest - 1e-9)
    step = p.record.step / substeps
    state = np.zeros((len(starts), max(1, len(model.states)))) if states is None else states[starts]
    inputs = np.zeros(p.q.shape) if p.input is None else p.input
    path = np.empty((len(starts), length, q.shape[1]))

    def called(call: NumpyFunction, k: int, q: Array, dq: Array, **more: Array) -> Array:
        known = {"q": q, "dq": dq, "input": inputs[starts + k], "parameters": parameters, "state": state}
        known |= {"time": p.time[starts + k][:, None], **more}
        return np.asarray(call(**{a.name: known[a.name] for a in call.function.arguments}))

    def onward(k: int, q: Array, dq: Array, ddq: Array, span: float) -> Array:
        if stepped is None:
            return state
        return called(stepped, k, q, dq, ddq=ddq, dt=np.full((len(starts), 1), span))

    state = onward(0, q, dq, called(forward, 0, q, dq), step / 2)
    for k in range(length):
        path[:, k] = q
        for _ in range(substeps):
            half = dq + step / 2 * called(forward, k, q, dq)
            middle = called(forward, k, q + step / 2 * dq, half)
            q = q + step * half
            dq, ddq = _held(dq, middle, partial(called, forward, k, q), step)
            state = onward(k, q, dq, ddq, step)
    return path


def _held(dq: Array, ddq: Array, accelerations: Callable[[Array], Array], step: float) -> tuple[Array, Array]:
    """Velocities after a step of the accelerations `ddq`, and the accelerations there, (W, n); both zero
    where dry friction holds a joint.

    It does where a joint that was at rest, or has turned, is driven back by the friction of its new
    direction. Its friction then lies between those of the two directions, and what the others feel of it.
    """
    moved = dq + step * ddq
    after = accelerations(moved)
    stuck = (moved * dq <= 0.0) & (after * moved < 0.0)
    change = np.where(stuck, after - ddq, 1.0)
    share = np.where(stuck, -moved / (step * change), 0.0).max(axis=1, keepdims=True)
    between = ddq + share * (after - ddq)
    moved = np.where(share > 0.0, dq + step * between, moved)
    return np.where(stuck, 0.0, moved), np.where(stuck, 0.0, np.where(share > 0.0, between, after))
