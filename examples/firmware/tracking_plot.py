"""The picture of the example: tracking errors, and where the limits were met."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import matplotlib as mpl
import numpy as np
from tracking_loop import Record

mpl.use("Agg")
import matplotlib.pyplot as plt

_COLOURS = ("0.65", "tab:orange", "tab:blue")


def plot(records: Sequence[Record], modes: Sequence[str], current_limit: float, path: Path) -> None:
    """Error of each joint over time in every mode, and below it angles and currents with the model."""
    joints = records[0].q.shape[1]
    figure, axes = plt.subplots(2, joints, figsize=(11, 5.6), sharex=True, layout="constrained")
    for j in range(joints):
        upper, lower = axes[:, j]
        for record, mode, colour in zip(records, modes, _COLOURS, strict=True):
            error = np.degrees(record.q[:, j] - record.reference[:, j])
            rms = np.degrees(record.rms[j])
            upper.plot(record.t, error, color=colour, linewidth=1.2, label=f"{mode}: RMS {rms:.3f}°")
        upper.set_title(f"joint {j + 1}")
        upper.axhline(0.0, color="0.8", linewidth=0.6, zorder=0)
        low, high = upper.get_ylim()
        upper.set_ylim(low, high + 0.42 * (high - low))
        upper.legend(fontsize="small", frameon=False, loc="upper right")
        last = records[-1]
        lower.plot(last.t, np.degrees(last.reference[:, j]), color="0.6", linewidth=2.5, label="reference")
        lower.plot(last.t, np.degrees(last.q[:, j]), color=_COLOURS[2], linewidth=1.0, label="angle")
        lower.set_xlabel("time [s]")
        twin = lower.twinx()
        twin.plot(last.t, last.current[:, j], color="tab:red", linewidth=0.8)
        for limit in (-current_limit, current_limit):
            twin.axhline(limit, color="tab:red", linewidth=0.8, linestyle=":")
        twin.set_ylim(-1.15 * current_limit, 1.15 * current_limit)
        twin.tick_params(axis="y", colors="tab:red")
        if j == joints - 1:
            twin.set_ylabel(f"current [A], limit ±{current_limit:g}", color="tab:red")
    axes[0, 0].set_ylabel("tracking error [deg]")
    axes[1, 0].set_ylabel("with the model [deg]")
    axes[1, 0].legend(fontsize="small", frameon=False, loc="lower center")
    figure.savefig(path, dpi=110, metadata={"Software": ""})
    plt.close(figure)
