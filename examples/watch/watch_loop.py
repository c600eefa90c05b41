"""The closed loop on the host, in C, as Python calls it."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from firmware.build import run
from numpy.typing import NDArray

HERE = Path(__file__).resolve().parent
JOINTS, PARAMETERS, STATES = 3, 24, 18
GIVEN, RESULT = 4 * JOINTS + 2 + STATES, STATES + JOINTS + 3
DT = 0.004  # s, of controller and observer
SLOW = 4  # steps of the observer in one of the monitor
KEPT = 2500  # steps before an alarm that are replayed on the board

Array = NDArray[np.float64]
_double, _joints, _parameters = ctypes.c_double, ctypes.c_double * JOINTS, ctypes.c_double * PARAMETERS


class Loop(ctypes.Structure):
    """loop_t."""

    _fields_ = [
        ("dt", _double),
        ("centre", _joints),
        ("amplitude", _double * (2 * JOINTS)),
        ("frequency", _double * (2 * JOINTS)),
        ("kp", _double),
        ("kd", _double),
        ("parameters", _parameters),
        ("assumed", _parameters),
        ("drift", _parameters),
        ("drift_time", _double),
        ("jump", _parameters),
        ("jump_time", _double),
        ("stop", _double),
        ("stop_time", _double),
        ("stiffness", _double),
        ("noise", _joints),
        ("noise_time", _double),
        ("steps", ctypes.c_long),
        ("seed", ctypes.c_ulonglong),
        ("substeps", ctypes.c_int),
        ("slow", ctypes.c_int),
        ("watching", ctypes.c_int),
        ("until_alarm", ctypes.c_int),
        ("kept", ctypes.c_long),
        ("outside_time", _double),
        ("changed_time", _double),
        ("touched_time", _double),
        ("step", ctypes.c_long),
        ("alarms", ctypes.c_long),
        ("outside", ctypes.c_int),
        ("changed", ctypes.c_int),
        ("named_time", _joints),
        ("largest", _joints),
        ("estimates", ctypes.c_float * 6),
    ]


def built(generated: Path, folder: Path, *, watching: bool) -> ctypes.CDLL:
    """The loop as a library below `folder`: plant in double and, where it is watched, the watch in float."""
    folder.mkdir(parents=True, exist_ok=True)
    common = ["cc", "-std=c99", "-O2", "-fno-math-errno", "-fPIC", f"-I{generated / 'include'}", "-c"]
    sources = sorted((generated / "src").glob("*.c"))
    for name, own, flags in (
        ("double", HERE / "loop.c", [f"-DWATCHING={int(watching)}"]),
        ("float", HERE / "watch.c", ["-DARIANE4_REAL=float"]),
    ):
        if name == "double" or watching:
            (folder / name).mkdir(exist_ok=True)
            run([*common, *flags, own, *sources], folder / name)
    objects = sorted(folder.glob("*/*.o"))
    run(["cc", "-shared", *objects, "-o", folder / "loop.so", "-lm"])
    return ctypes.CDLL(str(folder / "loop.so"))


def simulated(
    library: ctypes.CDLL, duration: float, values: Mapping[str, Any], *, record: bool = False
) -> Any:
    """A run of `duration` [s] with these fields of loop_t: it, its log (N, 7), the inputs before an alarm.

    Raises RuntimeError where the loop cannot go on.
    """
    usual = {"dt": DT, "substeps": 4, "slow": SLOW, "kept": KEPT, "kp": 100.0, "kd": 20.0}
    settings = Loop(steps=round(duration / DT), stop=9.0, drift_time=1.0, **usual)
    for name, value in values.items():
        kind = dict(Loop._fields_)[name]
        setattr(settings, name, kind(*np.ravel(value)) if np.ndim(value) else value)
    log = np.zeros((settings.steps if record else 1, 1 + 2 * JOINTS))
    last = np.zeros((KEPT, GIVEN), dtype=np.float32)
    status = library.loop(
        ctypes.byref(settings),
        ctypes.c_void_p(log.ctypes.data if record else None),
        ctypes.c_void_p(last.ctypes.data),
    )
    if status:
        raise RuntimeError(f"the loop ended with {status}")
    return settings, log, np.roll(last, -(settings.step % KEPT) - 1, axis=0)
