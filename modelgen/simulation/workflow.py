"""A simulation from options to a motion: alone, under control, or against logs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from modelgen.dataset import prepare, read
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.functions.nominal import is_nominal
from modelgen.functions.options import prepared
from modelgen.functions.parameters_file import values_beside, values_of
from modelgen.numeric import Array
from modelgen.options import ModelOptions, SimulationOptions
from modelgen.progress import Progress, silent
from modelgen.simulation.control import Control, controller
from modelgen.simulation.measured import HOLDS, Sensors, log_of
from modelgen.simulation.metrics import repeated, scores
from modelgen.simulation.output import facts, joint_scores
from modelgen.simulation.plant import Plant, plant
from modelgen.simulation.replay import Replay, replay
from modelgen.simulation.simulate import check_length, simulate
from modelgen.simulation.tables import inputs_of, reference_of
from modelgen.simulation.trajectory import Trajectory
from modelgen.simulation.values import by_joint, locks, numbers

SIMULATING = "simulating"


@dataclass(frozen=True)
class Simulated:
    """S samples of a simulated motion, and how it does against logs where there are any.

    t: (S,) [s]. q, dq: (S, n) joint coordinates [rad, m; /s]. inputs: (S, n) [A; N m, N], None of a free
    motion and of a replay. measured: (S, n) positions of the first log [rad, m]. replays, logs: one by log.
    trajectory: of a motion without a log. ended: why it stopped before its time, empty where it did not.
    note: where the parameters came from, empty where they are the description's or were given. log: columns
    of what a logger would have kept, None where nobody asked for it.
    """

    plant: Plant
    t: Array
    q: Array
    dq: Array
    inputs: Array | None = None
    measured: Array | None = None
    trajectory: Trajectory | None = None
    replays: tuple[Replay, ...] = ()
    logs: tuple[str, ...] = ()
    ended: str = ""
    note: str = ""
    log: Mapping[str, Array] | None = None

    @cached_property
    def data(self) -> dict[str, Any]:
        """Plain data that --json prints."""
        if self.trajectory is not None:
            return facts(self.plant, self.trajectory)
        return _scored(self)


def simulated(
    arm: Arm,
    logs: Sequence[Any] = (),
    options: SimulationOptions | None = None,
    progress: Progress = silent,
) -> Simulated:
    """The motion that the options ask for, with the inputs of each log where there are logs.

    Raises InputError for options that do not go together, and as `plant`, `simulate` and `read` do.
    """
    o = options or SimulationOptions()
    arm = prepared(arm, ModelOptions(without=o.without))
    parameters, note = values_of(o.parameters, [arm.name]) or None, ""
    if parameters is None and not o.lock and not is_nominal(arm):
        parameters = values_beside([arm], ModelOptions(without=o.without)).get(arm.name)
        if parameters is not None:
            note = (
                f"parameters: {arm.name}_parameters.yaml beside the description, which has no nominal values"
            )
    made = plant(arm, parameters, lock=locks(o.lock), payload=numbers("--payload", o.payload))
    sensors = _sensors(made, o)
    if logs and sensors is not None:
        raise InputError("--encoder, --hold, --noise, --jitter: the log has its own; expected no --log")
    found = _against(made, logs, o, progress) if logs else _alone(made, o, progress)
    kept = None if sensors is None else log_of(made, found.t, found.q, found.inputs, sensors)
    return replace(found, note=note, log=kept)


def _sensors(p: Plant, o: SimulationOptions) -> Sensors | None:
    """How the motion is read, None where nothing of that is asked for. Raises InputError."""
    if o.encoder_at not in ("joint", "motor"):
        raise InputError(f"--encoder-at: found '{o.encoder_at}', expected joint or motor")
    if o.hold and o.hold not in HOLDS:
        raise InputError(f"--hold: found '{o.hold}', expected {', '.join(HOLDS)}")
    counts, noise = by_joint("--encoder", o.encoder, p.names), by_joint("--noise", o.noise, p.names)
    for option, values in (("--encoder", counts), ("--noise", noise)):
        if (values < 0.0).any():
            raise InputError(f"{option}: found {values.min():g}, expected 0 or more")
    motor = o.encoder_at == "motor"
    if not (counts.any() or noise.any() or o.jitter or o.hold or motor):
        return None
    return Sensors(counts, motor, o.hold, noise, o.jitter, o.seed)


def _alone(p: Plant, o: SimulationOptions, progress: Progress) -> Simulated:
    """No log: from an initial state, free, with inputs, or under control along a reference."""
    if o.window is not None:
        raise InputError("--window cuts a log into windows: give --log FILE too")
    reference = None if o.reference is None else reference_of(p.n, o.reference)
    if bool(o.control) != (reference is not None):
        raise InputError("--control and --reference belong together: found one without the other")
    given = None if o.inputs is None else inputs_of(p, o.inputs)
    if given is not None and reference is not None:
        raise InputError("--input and --control: the inputs are given or controlled, not both")
    duration = o.duration
    if duration is None:
        axis = reference.t if reference is not None else None if given is None else given[0]
        if axis is None:
            raise InputError("--duration: found none, expected seconds, or --log, --input or --reference")
        duration = float(axis[-1] - axis[0])
    rate = 1000.0 if o.rate is None else o.rate
    begin = _somewhere(p) if reference is None else reference.at(reference.t[0])[0]
    q0 = by_joint("--q0", o.q0, p.names) if _given(o.q0) else begin
    control: Control | Array | None = None
    check_length(duration, rate)
    if given is not None:
        at = given[0][0] + np.arange(round(duration * rate) + 1) / rate
        control = given[1][np.searchsorted(given[0], at + 1e-9 / rate, side="right") - 1]
    if reference is not None:
        control = controller(p, o.control, reference, o.bandwidth, rate)
    found = simulate(
        p,
        q0,
        by_joint("--dq0", o.dq0, p.names),
        duration,
        rate,
        control,
        method=o.method,
        step=o.step,
        stop_at_limits=reference is not None,
        progress=lambda t: progress(SIMULATING, t, duration),
    )
    inputs = None if control is None else found.input
    return Simulated(p, found.t, found.q, found.dq, inputs, trajectory=found, ended=found.ended)


def _against(p: Plant, logs: Sequence[Any], o: SimulationOptions, progress: Progress) -> Simulated:
    """Every log's inputs, from its own initial state."""
    for option, value in (
        ("--duration", o.duration),
        ("--rate", o.rate),
        ("--reference", o.reference),
        ("--input", o.inputs),
    ):
        if value is not None:
            raise InputError(f"{option}: the log has its own; use FILE@t0:t1 for a part of it")
    start = None
    if _given(o.q0):
        start = by_joint("--q0", o.q0, p.names), by_joint("--dq0", o.dq0, p.names)
    records = [prepare(read(log, p.arm, o.mapping)) for log in logs]
    total = sum(float(x.time[-1] - x.time[0]) for x in records)
    found: list[Replay] = []
    done = 0.0

    def told(t: float) -> None:
        progress(SIMULATING, done + t, total)

    for record in records:
        found.append(
            replay(
                p,
                record,
                window=o.window,
                control=o.control,
                bandwidth=o.bandwidth,
                method=o.method,
                step=o.step,
                start=start,
                progress=told,
            )
        )
        done += float(record.time[-1] - record.time[0])
    steps = [float(one.t[1] - one.t[0]) for one in found]
    if np.ptp(steps) > 1e-3 * steps[0]:
        raise InputError("--log: runs of different sampling periods cannot be averaged; resample them alike")
    first = found[0]
    ran = np.isfinite(first.simulated).all(axis=1)
    return Simulated(
        p,
        first.t[ran],
        first.simulated[ran],
        first.velocities[ran],
        measured=first.measured[ran],
        replays=tuple(found),
        logs=tuple(x.record.name for x in records),
        ended=first.ended,
    )


def _scored(s: Simulated) -> dict[str, Any]:
    """Scores of the only run, or of the mean of all with each run's own beside it."""
    found = s.replays
    runs = [
        {
            "log": log,
            "windows": one.windows,
            "joints": joint_scores(s.plant, one.scores),
            "ended": one.ended or None,
        }
        for log, one in zip(s.logs, found, strict=True)
    ]
    data: dict[str, Any] = {
        "arm": s.plant.arm.name,
        "windows": found[0].windows,
        "ended": found[0].ended or None,
    }
    if len(found) == 1:
        return data | {"joints": runs[0]["joints"]}
    measured, scatter = repeated([one.measured for one in found])
    motion, _ = repeated([one.simulated for one in found])
    ran = np.isfinite(motion).all(axis=1)
    joints = joint_scores(s.plant, scores(measured[ran], motion[ran]))
    for joint, x in zip(joints, scatter, strict=True):
        joint["scatter"] = float(x)
    return data | {"joints": joints, "runs": runs}


def _given(q0: Any) -> bool:
    return not isinstance(q0, str) or bool(q0)


def _somewhere(p: Plant) -> Array:
    """0 where the stroke has it, else the stroke's middle."""
    low, high = p.strokes
    inside = (low <= 0) & (high >= 0)
    with np.errstate(invalid="ignore"):
        return np.where(inside, 0.0, (low + high) / 2)
