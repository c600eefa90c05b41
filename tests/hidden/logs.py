"""What a logger would have kept of a motion: encoder steps, noise on the current, a CSV file."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.random import Generator
from scipy.signal import lfilter

from hidden import native
from hidden.native import Array, Plant

WHITE, COLOURED = 0.05, 0.02  # of the RMS of the current without effects
COLOUR = 2.0  # Hz, corner of the coloured part


@dataclass(frozen=True)
class Log:
    """One record. reading: (N, n) as the encoders give it; motor_side: which are motor coordinates.

    current: (N, n) [A] with noise, held from its stamp on; None for a free motion.
    truth: (N, n) joint coordinates.
    """

    rate: float
    reading: Array
    motor_side: tuple[bool, ...]
    current: Array | None
    truth: Array

    @property
    def t(self) -> Array:
        return np.arange(len(self.reading)) / self.rate


def noise(count: int, size: Array, rate: float, random: Generator) -> Array:
    """White and coloured noise (count, n) [A] in proportion to `size` (n,) [A]."""
    white = random.normal(size=(count, len(size)))
    pole = np.exp(-2 * np.pi * COLOUR / rate)
    coloured = lfilter([np.sqrt(1 - pole**2)], [1, -pole], random.normal(size=white.shape), axis=0)
    return np.asarray(size * (WHITE * white + COLOURED * coloured))


def take(plant: Plant, rate: float, duration: float, random: Generator, substeps: int, size: Array) -> Log:
    """Runs the arm and logs it, with noise in proportion to `size` (n,) [A]; none on a free motion.

    Raises PlantError where the motion leaves its bounds.
    """
    n = int(plant["n"])
    truth, reading, current, _ = native.simulate(
        plant, rate, duration, substeps, warm_up=0.0 if plant["free"] else 2.0
    )
    side = tuple(bool(plant["joint_side"][j] < 0.5) for j in range(n))
    steps = plant["count"][:n]
    offset = plant["reading_offset"][:n]
    whole = np.where(steps > 0, np.round(offset / np.where(steps > 0, steps, 1.0)) * steps, offset)
    logged = None if plant["free"] else current + noise(len(current), size, rate, random)
    return Log(rate, reading + whole, side, logged, truth)


def write(path: Path, log: Log) -> None:
    """The log as CSV: t, q<n> or qm<n>, i<n>."""
    n = log.reading.shape[1]
    names = ["t", *(f"{'qm' if log.motor_side[j] else 'q'}{j + 1}" for j in range(n))]
    table, formats = [log.t[:, None], log.reading], ["%.6g", *["%.9g"] * n]
    if log.current is not None:
        names += [f"i{j + 1}" for j in range(n)]
        table.append(log.current)
        formats += ["%.5g"] * n
    with path.open("w", encoding="ascii", newline="") as file:
        np.savetxt(file, np.hstack(table), fmt=formats, delimiter=",", header=",".join(names), comments="")


def joints_of(log: Log, described: Plant) -> Array:
    """Joint coordinates (N, n) as the described drives give them."""
    columns = [
        native.joint_from_motor(described, j, log.reading[:, j]) if log.motor_side[j] else log.reading[:, j]
        for j in range(log.reading.shape[1])
    ]
    return np.column_stack(columns)
