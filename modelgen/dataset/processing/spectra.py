"""Text and a picture show what the filters do: spectra of positions and efforts, with the cut-offs."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import signal

from modelgen.dataset.processing.filters import low_pass
from modelgen.dataset.processing.prepare import Prepared
from modelgen.figures import COLOURS, figure, svg
from modelgen.numeric import Array

RAW, FILTERED = "#9aa5b1", COLOURS[0]
POINTS = 300  # of a curve, at most: the picture stays small


def described(prepared: Prepared) -> list[str]:
    """The processing in words, a line per step; then the reader's remarks."""
    s, rate = prepared.settings, 1.0 / prepared.record.step
    passes = "forwards and backwards (zero phase)"
    lines = [f"record: {len(prepared.time)} samples at {rate:.6g} Hz"]
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
    every = f"every {_ordinal(s.factor)} sample" if s.spacing is None else f"a sample every {s.spacing:.5g}"
    lines.append(f"rows: {every}, {s.trim:.3g} s cut off at both ends: {rows} rows")
    moving = ", ".join(f"{100 * share:.0f} %" for share in prepared.moving.mean(axis=0))
    lines.append(f"rows in which the joints move: {moving}")
    return [*lines, *prepared.record.remarks]


def _ordinal(n: int) -> str:
    ends = {1: "st", 2: "nd", 3: "rd"}
    return f"{n}{'th' if 10 <= n % 100 <= 20 else ends.get(n % 10, 'th')}"


def spectra_svg(prepared: Prepared) -> str:
    """The picture as SVG text, the same in every run.

    Above: amplitude densities of the positions, raw and filtered; below: of the efforts in the log's units;
    a column per joint.
    """
    made, grid = figure(2, prepared.n, (2.6 * max(prepared.n, 2), 4.6))
    for k in range(prepared.n):
        _position(grid[0][k], prepared, k)
        _effort(grid[1][k], prepared, k)
        grid[1][k].set_xlabel("frequency [Hz]")
    return svg(made)


def _position(axes: Any, prepared: Prepared, k: int) -> None:
    record, s = prepared.record, prepared.settings
    raw = record.motor if record.motor_side and record.motor_side[k] else record.q
    rate = 1.0 / record.step
    column = raw[:, k : k + 1]
    filtered = low_pass(column, s.position_cutoff, rate, s.position_order) if s.position_cutoff else column
    _curves(axes, column[:, 0], filtered[:, 0], rate)
    _cutoff(axes, s.position_cutoff)
    joint = _joint(prepared, k)
    axes.set_title(joint)
    if k == 0:
        axes.set_ylabel("position, per √Hz")


def _effort(axes: Any, prepared: Prepared, k: int) -> None:
    if prepared.input is None or prepared.gain is None:
        axes.text(0.5, 0.5, "free motion", ha="center", transform=axes.transAxes)
        return
    s, rate = prepared.settings, 1.0 / prepared.record.step
    column = (prepared.input * prepared.gain)[:, k : k + 1]
    filtered = low_pass(column, s.cutoff, rate, s.order) if s.cutoff else column
    _curves(axes, column[:, 0], filtered[:, 0], rate)
    _cutoff(axes, s.cutoff)
    axes.set_ylabel(f"effort [{prepared.effort_unit[k]}/√Hz]")


def _curves(axes: Any, raw: Array, filtered: Array, rate: float) -> None:
    window = min(len(raw), max(256, round(8 * rate)))
    top = 1.0
    for values, colour, name in ((raw, RAW, "raw"), (filtered, FILTERED, "filtered")):
        f, power = signal.welch(values, fs=rate, nperseg=window, detrend="linear")
        density = np.sqrt(np.maximum(power[1:], 1e-300))
        # Evenly spaced on the logarithmic axis, so that the picture stays small.
        chosen = np.unique(np.geomspace(1, len(density), POINTS).round().astype(int)) - 1
        axes.loglog(f[1:][chosen], density[chosen], color=colour, lw=0.8, label=name)
        top = float(density.max()) if name == "raw" else top
    axes.set_ylim(1e-7 * top, 3 * top)
    axes.legend(loc="lower left")


def _cutoff(axes: Any, cutoff: float) -> None:
    if cutoff:
        axes.axvline(cutoff, color="black", lw=0.8, ls="--")
        axes.annotate(
            f"{cutoff:.3g} Hz",
            (cutoff, 0.97),
            xycoords=("data", "axes fraction"),
            xytext=(3, -6),
            textcoords="offset points",
        )


def _joint(prepared: Prepared, k: int) -> str:
    arm = prepared.record.arm
    return arm.joints[arm.coordinates[k]].name if arm is not None else f"joint {k + 1}"
