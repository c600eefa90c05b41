"""Sketches of the pictures of a diagnosis: efforts, what is left over, simulated motion."""

from __future__ import annotations

import numpy as np
from markupsafe import Markup

from modelgen.dataset.drives import drives_of
from modelgen.diagnosis.equations import Rows
from modelgen.diagnosis.result import Diagnosis
from modelgen.figures import COLOURS
from modelgen.numeric import Array
from modelgen.report.figures import Sketch

_WINDOWS = 12  # that the picture of the simulation shows
_SECONDS = 10.0  # of the test record that the pictures over time show
HELD = 5  # samples, at least, that a mean is taken of


def effort(d: Diagnosis) -> Sketch:
    """Measured and predicted effort, and what is left, over the first seconds of the test record."""
    held, t = d.test, d.test.prepared.t
    shown = t <= t[0] + _SECONDS
    n = held.effort.shape[1]
    made = Sketch(n, 2, (9.0, 1.9 * n))
    axes = made.axes()
    measured, free = measured_efforts(held), held.prepared.input is None
    units = units_of(d)
    for j in range(n):
        # at rest dry friction has any value: nothing is predicted
        missed = [np.where(held.moving, r, np.nan) for r in d.residuals]
        before, after = (measured - r for r in missed)
        left, right = axes[j]
        left.plot(t[shown], measured[shown, j], color="#999999", label="of the links" if free else "measured")
        left.plot(t[shown], before[shown, j], color=COLOURS[0], label="model as described")
        if d.causes:
            left.plot(t[shown], after[shown, j], color=COLOURS[1], label="extended model")
        left.set_ylabel(f"joint {j + 1} [{units[j]}]")
        right.plot(t[shown], missed[0][shown, j], color=COLOURS[0], linewidth=0.8)
        if d.causes:
            right.plot(t[shown], missed[1][shown, j], color=COLOURS[1], linewidth=0.8)
        right.set_ylabel(f"left over [{units[j]}]")
    axes[0, 0].legend(loc="upper right", fontsize=7)
    for axis in axes[-1]:
        axis.set_xlabel("time [s]")
    return made


def measured_efforts(held: Rows) -> Array:
    """(M, n) in the unit of the log, at rest as well; those that the links take of a free motion."""
    p = held.prepared
    return np.asarray((held.effort if p.input is None else p.effort) * held.gain)


def units_of(d: Diagnosis) -> list[str]:
    """Units of the residual efforts, by joint."""
    if d.test.prepared.input is not None:
        return list(d.test.prepared.effort_unit) or ["A"] * len(d.arm.coordinates)
    joints = [d.arm.joints[i] for i in d.arm.coordinates]
    forces = ["N" if j.type == "prismatic" else "N m" for j in joints]
    return ["A" if j.drive.driven else u for j, u in zip(joints, forces, strict=True)]


def _position_units(d: Diagnosis) -> list[str]:
    """Units of the joint coordinates."""
    return ["m" if d.arm.joints[i].type == "prismatic" else "rad" for i in d.arm.coordinates]


def _against(d: Diagnosis) -> dict[str, tuple[Array, list[str]]]:
    """Abscissae for the residuals of the test record: (M, n) each, and their units by joint."""
    p, positions = d.test.prepared, _position_units(d)
    n = len(positions)
    driven = zip(drives_of(d.arm), positions, strict=True)
    motors = [drive.unit if drive.driven else unit for drive, unit in driven]
    motors = ["motor unit" if unit == "unit" else unit for unit in motors]
    found = {
        "joint velocity": (p.picked(p.dq), [f"{unit}/s" for unit in positions]),
        "joint position": (p.picked(p.q), positions),
        "size of the effort": (np.abs(measured_efforts(d.test)), units_of(d)),
        "motor position": (p.picked(p.motor), motors),
        "time": (np.tile(p.t[:, None], (1, n)), ["s"] * n),
    }
    if p.temperature is not None:
        found["temperature"] = (p.picked(p.temperature), ["deg C"] * n)
    return found


def residuals(d: Diagnosis) -> dict[str, Sketch]:
    """Residuals against speed, position, load, motor angle and time, before and after."""
    held = d.test
    n, efforts = held.effort.shape[1], units_of(d)
    pictures = {}
    for name, (x, units) in _against(d).items():
        made = Sketch(1, n, (max(3.0, min(9.0, 3.0 * n)), 2.0))
        axes = made.axes()
        for j in range(n):
            m = held.moving[:, j]
            for k, r in enumerate(d.residuals[: 2 if d.causes else 1]):
                centre, mean = binned(x[m, j], r[m, j], 120 if name == "motor position" else 24)
                axes[0, j].plot(centre, mean, color=COLOURS[k], marker=".", markersize=3)
            axes[0, j].axhline(0.0, color="#999999", linewidth=0.6)
            axes[0, j].set_xlabel(f"{name} [{units[j]}], joint {j + 1}", fontsize=7)
            if not j or efforts[j] != efforts[j - 1]:
                axes[0, j].set_ylabel(f"left over [{efforts[j]}]", fontsize=7)
        pictures[name] = made
    return pictures


def left_over(d: Diagnosis) -> Sketch:
    """Means of what is left over by speed, motor position and effort, before and after."""
    held, against = d.test, _against(d)
    n = held.effort.shape[1]
    made = Sketch(n, 3, (9.0, 1.9 * n + 0.3))
    axes = made.axes()
    shown = (("joint velocity", 24), ("motor position", 120), ("size of the effort", 24))
    for j in range(n):
        m = held.moving[:, j]
        for axis, (name, bins) in zip(axes[j], shown, strict=True):
            x, units = against[name]
            for k, r in enumerate(d.residuals[: 2 if d.causes else 1]):
                axis.plot(*binned(x[m, j], r[m, j], bins), color=COLOURS[k], linewidth=0.9)
            axis.axhline(0.0, color="#999999", linewidth=0.6)
            if j == n - 1 or units[j] != units[j + 1]:
                axis.set_xlabel(f"{name} [{units[j]}]", fontsize=7)
        axes[j, 0].set_ylabel(f"joint {j + 1} [{units_of(d)[j]}]", fontsize=7)
    return made


def binned(x: Array, y: Array, bins: int = 24) -> tuple[Array, Array]:
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


def replayed(d: Diagnosis) -> Sketch | None:
    """Measured and simulated positions of the first windows of the test record, and their difference."""
    shown = [s for s in d.simulation if s is not None]
    if not shown:
        return None
    n = shown[0].measured.shape[2]
    made = Sketch(n, 2, (9.0, 2.1 * n))
    axes = made.axes()
    labels = (("model as described", COLOURS[0]), ("extended model", COLOURS[1]))
    unit = _position_units(d)
    for j in range(n):
        left, right = axes[j]
        for scores, (label, colour) in zip(d.simulation, labels, strict=True):
            if scores is None or (label == "extended model" and not d.causes):
                continue
            for w in range(min(_WINDOWS, len(scores.t))):
                t, path, truth = scores.t[w], scores.simulated[w, :, j], scores.measured[w, :, j]
                if colour == COLOURS[0]:
                    left.plot(t, truth, color="#999999", linewidth=2.2, label="measured" if w == 0 else None)
                left.plot(t, path, color=colour, linewidth=0.9, label=label if w == 0 else None)
                right.plot(t, path - truth, color=colour, linewidth=0.9)
        left.set_ylabel(f"joint {j + 1} [{unit[j]}]")
        right.set_ylabel(f"off by [{unit[j]}]")
    axes[0, 0].legend(loc="upper right", fontsize=7)
    for axis in axes[-1]:
        axis.set_xlabel("time [s]")
    return made


def inline(text: str) -> Markup:
    """The picture from its svg element on, which stands in the page as it is."""
    return Markup(text[text.index("<svg") :])
