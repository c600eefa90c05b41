"""Text and a picture show what the filters do: spectra of positions and efforts, with the cut-offs."""

from __future__ import annotations

import numpy as np
from scipy import signal

from modelgen.charts import Chart, Curve, at_joints, sheet
from modelgen.dataset.processing.filters import low_pass
from modelgen.dataset.processing.prepare import Prepared
from modelgen.numeric import Array

POINTS = 300  # of a curve, at most: the picture stays small


def described(prepared: Prepared, records: int = 1, samples: int | None = None) -> list[str]:
    """The processing in words, a line per step; then the reader's remarks.

    records: how many there are, of which `prepared` is the first; samples: of all of them, where it is not
    the only one.
    """
    s, rate = prepared.settings, 1.0 / prepared.record.step
    passes = "forwards and backwards (zero phase)"
    several = records > 1
    count = samples if several and samples is not None else len(prepared.time)
    lines = [f"{f'{records} training records' if several else 'record'}: {count} samples at {rate:.6g} Hz"]
    if s.position_cutoff:
        lines.append(
            f"positions: Butterworth, order {s.position_order}, {s.position_cutoff:.4g} Hz, {passes}; "
            f"derivatives by central differences of order {2 * s.half_width}"
        )
    else:
        lines.append(
            f"positions: not filtered; derivatives by central differences of order {2 * s.half_width}"
        )
    if prepared.record.hold:
        lines.append(f"effort: moved by {1e3 * prepared.record.hold:.4g} ms to the instants of the positions")
    if s.cutoff:
        lines.append(f"effort and regressor alike: Butterworth, order {s.order}, {s.cutoff:.4g} Hz, {passes}")
    else:
        lines.append("effort and regressor: not filtered")
    rows = len(prepared.rows)
    factor = _ordinal(s.factor)
    every = f"every {factor} sample" if s.spacing is None else f"a row every {s.spacing:.5g} samples"
    whose = f" ({prepared.record.name}, the first record)" if several else ""
    lines.append(f"rows{whose}: {every}, {s.trim:.3g} s cut off at both ends: {rows} rows")
    moving = [f"{100 * share:.0f} %" for share in prepared.moving.mean(axis=0)]
    lines.append(f"rows that move{whose}: {at_joints(prepared.record.joint_names, moving)}")
    return [*lines, *prepared.record.remarks]


def _ordinal(n: int) -> str:
    ends = {1: "st", 2: "nd", 3: "rd"}
    return f"{n}{'th' if 10 <= n % 100 <= 20 else ends.get(n % 10, 'th')}"


def spectra(prepared: Prepared) -> list[Chart]:
    """Amplitude densities of positions and efforts of every joint, raw and filtered, with the cut-offs."""
    charts = []
    for k in range(prepared.n):
        charts += [_position(prepared, k), _effort(prepared, k)]
    return charts


def spectra_svg(prepared: Prepared) -> str:
    """The spectra as SVG text, the same in every run: a row for each joint."""
    return sheet(spectra(prepared), 2)


def _position(prepared: Prepared, k: int) -> Chart:
    record, s = prepared.record, prepared.settings
    at_motor = bool(record.motor_side and record.motor_side[k])
    column = (record.motor if at_motor else record.q)[:, k : k + 1]
    rate, unit = 1.0 / record.step, _unit(prepared, k, at_motor=at_motor)
    filtered = low_pass(column, s.position_cutoff, rate, s.position_order) if s.position_cutoff else column
    name = prepared.record.joint_names[k]
    return _chart(f"{name}, position", f"position [{unit}/√Hz]", column, filtered, rate, s.position_cutoff)


def _effort(prepared: Prepared, k: int) -> Chart:
    name = prepared.record.joint_names[k]
    if prepared.input is None or prepared.gain is None:
        return Chart(f"{name}: free motion", "frequency [Hz]", "no effort [-]", [])
    s, rate = prepared.settings, 1.0 / prepared.record.step
    column = (prepared.input * prepared.gain)[:, k : k + 1]
    filtered = low_pass(column, s.cutoff, rate, s.order) if s.cutoff else column
    label = f"effort [{prepared.effort_unit[k]}/√Hz]"
    return _chart(f"{name}, effort", label, column, filtered, rate, s.cutoff)


def _chart(title: str, label: str, raw: Array, filtered: Array, rate: float, cutoff: float) -> Chart:
    window = min(len(raw), max(256, round(8 * rate)))
    curves, top = [], 1.0
    for values, role, name in ((raw[:, 0], "measured", "raw"), (filtered[:, 0], "before", "filtered")):
        f, power = signal.welch(values, fs=rate, nperseg=window, detrend="linear")
        density = np.sqrt(np.maximum(power[1:], 1e-300))
        # Evenly spaced on the logarithmic axis, so that the picture stays small.
        chosen = np.unique(np.geomspace(1, len(density), POINTS).round().astype(int)) - 1
        curves.append(Curve(f[1:][chosen], density[chosen], role, name))
        top = float(density.max()) if name == "raw" else top
    low, high = 1e-7 * top, 3.0 * top
    if cutoff:
        curves.append(Curve(np.array([cutoff, cutoff]), np.array([low, high]), "law", "cut-off"))
        title += f", cut-off {cutoff:.3g} Hz"
    text = f"Spectrum of {title}, raw and filtered."
    return Chart(title, "frequency [Hz]", label, curves, text, y_range=(low, high), logarithmic=True)


def _unit(prepared: Prepared, k: int, *, at_motor: bool) -> str:
    arm = prepared.record.arm
    if at_motor or arm is None:
        return "motor unit" if at_motor else "rad or m"
    return arm.coordinate_units[k]
