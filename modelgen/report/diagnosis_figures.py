"""Charts of a diagnosis: efforts, residuals, simulated motion."""

from __future__ import annotations

import numpy as np

from modelgen.charts import Chart, Curve, over_time
from modelgen.dataset.drives import drives_of
from modelgen.diagnosis.equations import Rows
from modelgen.diagnosis.result import Diagnosis
from modelgen.numeric import Array
from modelgen.report.motion_figures import Motion, joined, motion_pair

WINDOWS = 24  # of the simulated motion that are shown
BINS = 24  # over an abscissa
HELD = 5  # samples, at least, that a mean is made of
BEFORE, AFTER = "model as described", "extended model"


def efforts(d: Diagnosis) -> list[Chart]:
    """Measured and predicted effort and the residual of every joint, over the whole test record."""
    held, t = d.test, d.test.prepared.t
    measured, free = measured_efforts(held), d.free
    # at rest dry friction has any value: nothing is predicted
    missed = [np.where(held.moving, r, np.nan) for r in d.residuals]
    units, charts = units_of(d), []
    word = "needed by the links" if free else "measured"
    for j, name in enumerate(d.arm.coordinate_names):
        curves = [Curve(t, measured[:, j], "measured", word)]
        left = [Curve(t, missed[0][:, j], "before", BEFORE)]
        curves.append(Curve(t, measured[:, j] - missed[0][:, j], "before", BEFORE))
        if d.causes:
            curves.append(Curve(t, measured[:, j] - missed[1][:, j], "after", AFTER))
            left.append(Curve(t, missed[1][:, j], "after", AFTER))
        text = f"Effort of {name} over the test record, measured and predicted."
        charts.append(over_time(name, f"effort [{units[j]}]", curves, text, t[0], zoom=True))
        text = f"Residual of {name} over the test record, measured less predicted effort."
        title, label = f"{name}, residual", f"residual [{units[j]}]"
        charts.append(over_time(title, label, left, text, t[0], zoom=True))
    return charts


def measured_efforts(held: Rows) -> Array:
    """(M, n) in the unit of the log, at rest as well; those that the links need in a free motion."""
    p = held.prepared
    return np.asarray((held.effort if p.input is None else p.effort) * held.gain)


def units_of(d: Diagnosis) -> list[str]:
    """Units of the residual efforts, by joint."""
    if d.test.prepared.input is not None:
        return list(d.test.prepared.effort_unit) or ["A"] * len(d.arm.coordinates)
    joints = [d.arm.joints[i] for i in d.arm.coordinates]
    forces = ["N" if j.type == "prismatic" else "N m" for j in joints]
    return ["A" if j.drive.driven else u for j, u in zip(joints, forces, strict=True)]


def against(d: Diagnosis) -> dict[str, tuple[Array, list[str]]]:
    """Abscissae for the residuals of the test record: (M, n) each, and their units by joint."""
    p, positions = d.test.prepared, d.arm.coordinate_units
    driven = zip(drives_of(d.arm), positions, strict=True)
    motors = [drive.unit if drive.driven else unit for drive, unit in driven]
    motors = ["motor unit" if unit == "unit" else unit for unit in motors]
    found = {
        "speed": (p.picked(p.dq), [f"{unit}/s" for unit in positions]),
        "position": (p.picked(p.q), positions),
        "load (size of the effort)": (np.abs(measured_efforts(d.test)), units_of(d)),
        "motor position": (p.picked(p.motor), motors),
        "acceleration": (p.picked(p.ddq), [f"{unit}/s^2" for unit in positions]),
    }
    if p.temperature is not None:
        found["temperature"] = (p.picked(p.temperature), ["deg C"] * len(positions))
    return found


def bins_of(name: str) -> int:
    """Number of bins over an abscissa: what repeats with the motor's turns asks for many."""
    return 120 if name == "motor position" else BINS


def residuals(d: Diagnosis) -> dict[str, list[Chart]]:
    """Means of the residuals over bins of speed, position, load and so on, before and after, by joint."""
    held, efforts, names = d.test, units_of(d), d.arm.coordinate_names
    found = {}
    for over, (x, units) in against(d).items():
        charts = []
        for j, name in enumerate(names):
            m = held.moving[:, j]
            curves = [
                Curve(*binned(x[m, j], r[m, j], bins_of(over)), role, label)
                for r, role, label in zip(
                    d.residuals[: 2 if d.causes else 1], ("before", "after"), (BEFORE, AFTER), strict=False
                )
            ]
            text = f"Mean residual of {name} over {over}."
            charts.append(Chart(name, f"{over} [{units[j]}]", f"residual [{efforts[j]}]", curves, text))
        found[over] = charts
    return found


def binned(x: Array, y: Array, bins: int = BINS) -> tuple[Array, Array]:
    """Means over bins of equal width that hold five samples at least; of a short record over five each."""
    if len(x) < HELD:
        return np.zeros(0), np.zeros(0)
    if len(x) < HELD * bins:
        groups = np.array_split(np.argsort(x, kind="stable"), len(x) // HELD)
        return np.array([x[g].mean() for g in groups]), np.array([y[g].mean() for g in groups])
    edges = np.linspace(x.min(), x.max() + 1e-12, bins + 1)
    place = np.clip(np.digitize(x, edges) - 1, 0, bins - 1)
    count = np.bincount(place, minlength=bins)
    total = np.bincount(place, weights=y, minlength=bins)
    full = count >= HELD
    return ((edges[1:] + edges[:-1]) / 2)[full], total[full] / count[full]


def replayed(d: Diagnosis) -> list[Chart]:
    """Measured and simulated positions of windows of the test record, and their difference."""
    models = zip(d.simulation, ("before", "after"), (BEFORE, AFTER), strict=True)
    shown = [
        (s, role, label) for s, role, label in models if s is not None and (role == "before" or d.causes)
    ]
    unit, charts, begin = d.arm.coordinate_units, [], d.test.prepared.t[0]
    for j, name in enumerate(d.arm.coordinate_names if shown else ()):
        motions = []
        for s, role, label in shown:
            t, measured, simulated = (
                joined(x[:WINDOWS]) for x in (s.t, s.measured[:, :, j], s.simulated[:, :, j])
            )
            motions.append(Motion(t, measured, simulated, role, label))
        charts += motion_pair(name, unit[j], motions, begin)
    return charts
