"""Charts of a joint's simulated motion beside the measured one."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from modelgen.charts import Chart, Curve, over_time, within
from modelgen.numeric import Array

_FINE = {"rad": (1e3, "mrad"), "m": (1e3, "mm")}  # factor and unit in which small errors are said
_COARSE = 0.01  # rad, m: from which on they are said in these


@dataclass(frozen=True)
class Motion:
    """A model's motion. t, measured, simulated: (S,) [s, rad or m], as `joined`."""

    t: Array
    measured: Array
    simulated: Array
    role: str
    label: str


def motion_pair(
    name: str, unit: str, motions: Sequence[Motion], begin: float, error: float | None = None
) -> list[Chart]:
    """Measured and simulated positions of a joint, and their difference.

    Of a simulated motion that runs away as much is drawn as leaves the measured one legible. The measured one
    is that of the first of `motions`. begin: where the times count from [s]. error: the one by whose size the
    unit of the differences is chosen, that of the positions without.
    """
    t, measured = motions[0].t, motions[0].measured
    paths = [Curve(t, measured, "measured", "measured")]
    paths += [Curve(m.t, m.simulated, m.role, m.label) for m in motions]
    left = [m.simulated - m.measured for m in motions]
    size, fine = (1.0, unit) if error is None else small(error, unit)
    errors = [Curve(m.t, size * e, m.role, m.label) for m, e in zip(motions, left, strict=True)]
    low, high = float(np.nanmin(measured)), float(np.nanmax(measured))
    return [
        over_time(
            name,
            f"position [{unit}]",
            paths,
            f"Position of {name}, measured and simulated.",
            begin,
            zoom=True,
            y_range=within(paths, 2 * low - high, 2 * high - low),
        ),
        over_time(
            f"{name}, error",
            f"error [{fine}]",
            errors,
            f"Simulated less measured position of {name}.",
            begin,
            zoom=True,
            y_range=within(errors, size * (low - high), size * (high - low)),
        ),
    ]


def small(value: float, unit: str) -> tuple[float, str]:
    """Factor and unit in which a value of that size can be read: mrad or mm where it is small."""
    return _FINE.get(unit, (1.0, unit)) if abs(value) < _COARSE else (1.0, unit)


def joined(runs: Iterable[Array]) -> Array:
    """Runs (S, ...) one after the other, with a gap after each."""
    found = []
    for rows in runs:
        found += [np.asarray(rows, dtype=float), np.full((1, *rows.shape[1:]), np.nan)]
    return np.concatenate(found)
