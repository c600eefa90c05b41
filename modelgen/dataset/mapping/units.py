"""Units that a mapping file may declare, as factors to the units of docs/logs.md."""

from __future__ import annotations

import math
from collections.abc import Mapping

_TURN = 2 * math.pi
_ANGLE = {"rad": 1.0, "mrad": 1e-3, "deg": math.pi / 180, "rev": _TURN}
LENGTHS: Mapping[str, float] = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6}
TIMES: Mapping[str, float] = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
STEPS = (5e-5, 0.2)  # s, between samples of a robot
POSITIONS: Mapping[str, Mapping[str, float]] = {"rad": _ANGLE, "m": LENGTHS, "unit": {"counts": 1.0}}
# "rpm" and "rev/s" are common in drives' own logs.
VELOCITIES: Mapping[str, Mapping[str, float]] = {
    "rad": {**{f"{name}/s": factor for name, factor in _ANGLE.items()}, "rpm": _TURN / 60},
    "m": {f"{name}/s": factor for name, factor in LENGTHS.items()},
}
ACCELERATIONS: Mapping[str, Mapping[str, float]] = {
    "rad": {f"{name}/s^2": factor for name, factor in _ANGLE.items()},
    "m": {f"{name}/s^2": factor for name, factor in LENGTHS.items()},
}
TEMPERATURES: Mapping[str, float] = {"degC": 1.0}
# kind of the effort, and factor to A; N m or N; 1; V
EFFORTS: Mapping[str, tuple[str, float]] = {
    "A": ("current", 1.0),
    "mA": ("current", 1e-3),
    "N m": ("torque", 1.0),
    "N mm": ("torque", 1e-3),
    "kN m": ("torque", 1e3),
    "N": ("force", 1.0),
    "kN": ("force", 1e3),
    "duty": ("duty", 1.0),
    "%": ("duty", 1e-2),
    "V": ("voltage", 1.0),
    "mV": ("voltage", 1e-3),
}
EFFORT_UNITS: Mapping[str, str] = {"current": "A", "torque": "N m", "force": "N", "duty": "1", "voltage": "V"}


def plausible_times(step: float) -> dict[str, float]:
    """Units of stamps that are `step` apart from sample to sample in a robot's log, with the rates [Hz]."""
    low, high = STEPS
    return {unit: 1.0 / (step * factor) for unit, factor in TIMES.items() if low <= step * factor <= high}
