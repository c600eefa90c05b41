"""What a logger would have kept of a simulated motion: encoder counts, instants of the readings, noise."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from modelgen.dataset import drives_of
from modelgen.errors import InputError
from modelgen.numeric import Array
from modelgen.simulation.plant import Plant
from modelgen.simulation.tables import input_names

HOLDS = ("following", "instant", "previous")


@dataclass(frozen=True)
class Sensors:
    """How a motion is read.

    counts: (n,) of the encoders, in a turn or a metre, 0: exact. motor: whether they sit at the motors, a
    count being one of 2 pi of a motor coordinate in rad, and a unit of any other. hold: what the logged
    efforts are, as in a mapping file. noise: (n,) standard deviation of the efforts [A; N m, N]. jitter:
    standard deviation of the time of a sample [s], which its stamp says. seed: of noise and jitter.
    """

    counts: Array
    motor: bool
    hold: str
    noise: Array
    jitter: float
    seed: int


def log_of(p: Plant, t: Array, q: Array, inputs: Array | None, sensors: Sensors) -> dict[str, Array]:
    """Columns (S,) of a log, by name: t [s], q<n> [rad, m] or qm<n> [motor unit], and the inputs.

    q: (S, n) at times t (S,) [s]. inputs: (S, n), each constant from its time to the next; None of a free
    motion. Raises InputError for instants, or noise, of efforts that there are not.
    """
    if inputs is None and (sensors.noise.any() or sensors.hold):
        raise InputError("--noise, --hold: found a motion without inputs, expected --control or --input")
    random = np.random.default_rng(sensors.seed)
    noise = random.normal(size=q.shape)
    at = t
    if sensors.jitter:
        step = float(t[1] - t[0])
        if not 0.0 < sensors.jitter <= 0.25 * step:
            raise InputError(
                f"--jitter: found {sensors.jitter:g} s, expected at most a quarter of the period, {step:g} s"
            )
        # Beyond half a period stamps would change places.
        at = np.clip(
            t + np.clip(sensors.jitter * random.normal(size=len(t)), -0.45 * step, 0.45 * step), t[0], t[-1]
        )
        at[0], at[-1] = t[0], t[-1]
    columns = {"t": at}
    for k, drive in enumerate(drives_of(p.arm)):
        motor = sensors.motor and drive.driven
        x = _between(t, q[:, k], at)
        x = np.asarray(drive.motor(x)) if motor else x
        joint = p.arm.joints[p.arm.coordinates[k]]
        turns = drive.unit == "rad" if motor else joint.type != "prismatic"
        if sensors.counts[k]:
            count = (2 * np.pi if turns else 1.0) / sensors.counts[k]
            x = count * np.rint(x / count)
        columns[f"{'qm' if motor else 'q'}{k + 1}"] = x
    if inputs is not None:
        held = inputs[np.clip(np.searchsorted(t, at, side="right") - 1, 0, len(t) - 1)]
        before = np.vstack([held[:1], held[:-1]])
        read = {"instant": 0.5 * (held + before), "previous": before}.get(sensors.hold, held)
        columns |= dict(zip(input_names(p), (read + sensors.noise * noise).T, strict=True))
    return columns


def _between(t: Array, x: Array, at: Array) -> Array:
    """The cubic through the four samples around each time."""
    if at is t:
        return x
    step = float(t[1] - t[0])
    k = np.clip(((at - t[0]) / step).astype(int), 1, len(t) - 3)
    s = (at - t[k]) / step
    return np.asarray(
        -s * (s - 1) * (s - 2) / 6 * x[k - 1]
        + (s + 1) * (s - 1) * (s - 2) / 2 * x[k]
        - (s + 1) * s * (s - 2) / 2 * x[k + 1]
        + (s + 1) * s * (s - 1) / 6 * x[k + 2]
    )
