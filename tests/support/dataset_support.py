"""Arms with every kind of drive, and logs of smooth motions written to files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from modelgen.description import Arm, loads

ARMS = loads(
    """
schema: 1
convention: khalil_kleinfinger
arms:
  driven:
    joints:
      - {name: hip, limits: {position: [-2, 2]}, drive: {type: direct, ratio: 50, torque_constant: 0.1}}
      - name: knee
        d: 0.4
        drive: {type: levered, l1: 0.35, l2: 0.08, length: [0.30, 0.40], motor: [0, 20000], rev: 1,
                offset: -1, torque_constant: 1.0e-4}
  axis:
    joints:
      - {name: slide, type: prismatic, limits: {position: [-0.3, 0.3]}}
  free:
    joints:
      - {name: upper}
      - {name: held, d: 0.1}
      - {name: lower, d: 0.2}
    locked: {held: 0}
"""
)
DRIVEN, AXIS, FREE = ARMS["driven"], ARMS["axis"], ARMS["free"]
LEVER = {"l1": 0.35, "l2": 0.08, "low": 0.30, "high": 0.40, "counts": 20000.0, "offset": -1.0}


def counts_of(q: np.ndarray) -> np.ndarray:
    """Motor increments of the knee at the angle q [rad], by the law of cosines."""
    inner = q - LEVER["offset"]
    length = np.sqrt(LEVER["l1"] ** 2 + LEVER["l2"] ** 2 - 2 * LEVER["l1"] * LEVER["l2"] * np.cos(inner))
    return LEVER["counts"] * (length - LEVER["low"]) / (LEVER["high"] - LEVER["low"])


def motion(t: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """q, dq, ddq (N, 2) [rad] of a motion within the limits of `driven`."""
    w = 2 * np.pi * np.array([0.3, 0.5])
    phase, size, centre = np.array([0.4, 1.1]), np.array([1.0, 0.25]), np.array([0.1, 0.35])
    angle = np.outer(t, w) + phase
    return centre + size * np.sin(angle), size * w * np.cos(angle), -size * w**2 * np.sin(angle)


def times(seconds: float = 8.0, rate: float = 200.0) -> np.ndarray:
    return np.arange(round(seconds * rate)) / rate


def columns(t: np.ndarray) -> dict[str, np.ndarray]:
    """A complete log of `driven`."""
    q, dq, _ = motion(t)
    return {"t": t, "q1": q[:, 0], "qm2": counts_of(q[:, 1]), "i1": 2 * dq[:, 0], "i2": 1.0 + dq[:, 1]}


def write_csv(path: Path, table: Mapping[str, np.ndarray]) -> str:
    """A CSV log; returns its name."""
    lines = [",".join(table)]
    lines += [",".join(repr(float(x)) for x in row) for row in zip(*table.values(), strict=True)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return str(path)


__all__ = ["AXIS", "DRIVEN", "FREE", "LEVER", "Arm", "columns", "counts_of", "motion", "times", "write_csv"]

T = times()

AXIS_MAPPING = """
schema: 1
time: {column: stamp, unit: ms}
joints:
  - position: {column: pos, unit: mm, scale: -1, offset: 20}
    effort: {column: load / 885 * vin, unit: V}
    temperature: {column: temp}
"""

AXIS_LOG = {
    "stamp": 1e3 * T,
    "pos": 20 - 200 * np.cos(T),
    "load": 500 * np.sin(T),
    "vin": 7.0 + 0.1 * np.cos(T),
    "temp": 30 + T,
}
