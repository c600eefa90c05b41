"""A measured log and the motion that the model makes of its inputs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from modelgen.dataset import Prepared
from modelgen.dataset.processing.prepare import held_inputs
from modelgen.dataset.processing.released import free_samples
from modelgen.errors import InputError
from modelgen.numeric import Array
from modelgen.simulation.control import Control, Reference, controller
from modelgen.simulation.metrics import Scores, scores
from modelgen.simulation.plant import Plant
from modelgen.simulation.simulate import default_method, simulate
from modelgen.simulation.start import Motions, nearest_start


@dataclass(frozen=True)
class Replay:
    """t (S,) [s], measured and simulated positions (S, n), window by window with NaN where none ran.

    scores: of what was simulated. windows: how many. ended: why the last one stopped early, if it did.
    """

    t: Array
    measured: Array
    simulated: Array
    velocities: Array
    scores: Scores
    windows: int
    ended: str = ""


def replay(
    plant: Plant,
    prepared: Prepared,
    *,
    window: float | None = None,
    control: str = "",
    bandwidth: float = 5.0,
    method: str = "",
    step: float | None = None,
    start: tuple[Array, Array] | None = None,
    progress: Callable[[float], None] | None = None,
) -> Replay:
    """The record simulated from its measured initial state with its measured inputs.

    A record without effort is a free motion: it counts from its release on, as of `free_samples`, and without
    windows begins with the state that fits its first second best, `nearest_start`. window:
    length [s] after which the simulation starts again from the measured state (multiple shooting; Bock
    1983), so that an unstable arm remains comparable; by default the record is one window. control: "pi" or
    "computed_torque" follow the measured positions as their reference instead of the measured inputs
    (closed loop). start: q, dq (n,) at the beginning in place of the measured ones. Raises InputError where
    a window holds fewer than two samples.
    """
    p = prepared
    rate = 1.0 / p.record.step
    count = len(p.time)
    length = count if window is None else max(2, round(window * rate) + 1)
    if window is not None and (not np.isfinite(window) or window * rate < 1):
        raise InputError(f"--window {window:g}: found less than a sample of {1 / rate:g} s")
    inputs = held_inputs(p)
    simulated, velocities = np.full_like(p.q, np.nan), np.full_like(p.q, np.nan)
    ended = ""
    free = p.input is None and not control
    released = free_samples(p)[0] if free and start is None else 0
    begins = list(range(released, count - 1, length - 1))
    for begin in begins:
        last = min(count, begin + length)
        first = (p.q[begin], p.dq[begin]) if begin > released else start or beginning(p, released)
        given: Control | Array = inputs[begin:last]
        if control:
            reference = Reference(p.time[begin:last] - p.time[begin], p.q[begin:last])
            given = controller(plant, control, reference, bandwidth, rate)
        low, high = plant.strokes
        if free and start is None and window is None:
            near = _motions(plant, np.clip(first[0], low, high), first[1], rate, method, step)
            first = nearest_start(near, p.q[begin:last], p.record.step, *first)
        found = simulate(
            plant,
            np.clip(first[0], low, high),
            first[1],
            (last - 1 - begin) / rate,
            rate,
            None if free else given,
            method=method,
            step=step,
        )
        ran = slice(begin, begin + len(found.t))
        simulated[ran], velocities[ran] = found.q, found.dq
        ended = found.ended or ended
        if progress is not None:
            progress(float(p.time[last - 1] - p.time[0]))
    there = np.isfinite(simulated).all(axis=1)
    reached = scores(p.q[there], simulated[there])
    return Replay(p.time, p.q, simulated, velocities, reached, len(begins), ended)


def _motions(plant: Plant, q: Array, dq: Array, rate: float, method: str, step: float | None) -> Motions:
    """Free motions from starts about q, dq (n,), by compiled steps where they serve: they are many."""
    quick = method or default_method(plant, q, dq, compiled=True)
    low, high = plant.strokes

    def motions(starts: Array, speeds: Array, samples: int) -> Array:
        path, duration = np.full((len(starts), samples, plant.n), np.nan), (samples - 1) / rate
        for k, (at, speed) in enumerate(zip(starts, speeds, strict=True)):
            found = simulate(plant, np.clip(at, low, high), speed, duration, rate, method=quick, step=step)
            path[k, : len(found.q)] = found.q
        return path

    return motions


def beginning(prepared: Prepared, at: int = 0) -> tuple[Array, Array]:
    """q, dq (n,) where a motion begins, at a sample: measured rates where a log has them, or a parabola's.

    There a filter of both sides knows one side only; the parabola is fitted to the first samples as
    measured, over the time that the filter of the positions takes to respond, ten samples at least.
    """
    record = prepared.record
    if record.dq is not None:
        return record.q[at].copy(), record.dq[at].copy()
    cutoff = prepared.settings.position_cutoff
    span = 10 if not cutoff else max(10, round(0.5 / cutoff / record.step))
    rows = slice(at, at + span)
    t = record.t[rows] - record.t[at]
    fit = np.linalg.lstsq(np.vander(t, 3, increasing=True), record.q[rows], rcond=None)[0]
    return fit[0], fit[1]
