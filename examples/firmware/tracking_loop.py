"""The closed loop: a simulated arm on the host, its controller on the emulated board."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from firmware.build import run
from numpy.typing import NDArray
from tracking_board import GENERATED, HERE, Controller, message
from tracking_values import ARM, STEP, Values, reference

MODES = ("feedback alone", "with gravity", "with the model")
SUBSTEPS = 20  # of the plant in a step of the controller

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Record:
    """A run, one row per step: time [s], angle and reference within the strokes [rad], current [A]."""

    t: Array
    q: Array
    reference: Array
    current: Array

    @property
    def rms(self) -> Array:
        """Root mean square of the tracking error of each joint [rad]."""
        rms: Array = np.sqrt(np.mean((self.q - self.reference) ** 2, axis=0))
        return rms


def plant_library(folder: Path) -> Path:
    """The simulated arm as a library below `folder`. Raises RuntimeError where it does not compile."""
    library = folder / "plant.so"
    sources = [HERE / "plant.c", *sorted((GENERATED / "src").glob("*.c"))]
    flags = ["-std=c99", "-O2", "-ffp-contract=off", "-fPIC", "-shared", f"-I{GENERATED / 'include'}"]
    run(["cc", *flags, *sources, "-o", library, "-lm"])
    return library


class Plant:
    """The arm with parameters that the controller does not know, at its beginning."""

    def __init__(self, v: Values, library: Path) -> None:
        functions = ctypes.CDLL(str(library))
        self._advance, self._motor = functions.plant_advance, functions.ariane4_motor_from_joint
        self._parameters = v.plant_parameters.astype(np.float64)
        self.q, self.dq, _ = reference(0.0)

    def encoders(self) -> tuple[Array, Array]:
        """Motor coordinates and speeds, in whole increments [1, 1/s]. Raises RuntimeError beyond a stroke."""
        q_m, dq_m, ddq_m, ddq = np.zeros((4, len(self.q)))
        pointers = [ctypes.c_void_p(x.ctypes.data) for x in (self.q, self.dq, ddq, q_m, dq_m, ddq_m)]
        status = self._motor(*pointers)
        if status:
            raise RuntimeError(f"{ARM}: the drives returned the status {status} at q = {self.q}")
        return np.round(q_m), np.round(dq_m)

    def advance(self, current: Array) -> None:
        """One step of the controller with the currents held. Raises RuntimeError beyond a stroke."""
        held = np.ascontiguousarray(current, dtype=np.float64)
        pointers = [ctypes.c_void_p(x.ctypes.data) for x in (self.q, self.dq, held, self._parameters)]
        status = self._advance(*pointers, ctypes.c_double(STEP / SUBSTEPS), ctypes.c_int(SUBSTEPS))
        if status:
            raise RuntimeError(f"{ARM}: the plant returned the status {status} at q = {self.q}")


def closed_loop(board: Controller, plant: Plant, mode: int, duration: float) -> Record:
    """Run the loop for `duration` [s]. Raises RuntimeError where plant or controller report a status."""
    count = round(duration / STEP)
    t = np.arange(count, dtype=np.float64) * STEP
    q, asked, current = (np.empty((count, len(plant.q))) for _ in range(3))
    for k in range(count):
        motor, speed = plant.encoders()
        answer = board.step(message(motor, speed, reference(t[k]), mode)).astype(np.float64)
        if answer[6]:
            raise RuntimeError(f"the controller returned the status {answer[6]:g} at t = {t[k]:g} s")
        q[k], current[k], asked[k] = plant.q, answer[:3], answer[3:6]
        plant.advance(current[k])
    return Record(t, q, asked, current)
