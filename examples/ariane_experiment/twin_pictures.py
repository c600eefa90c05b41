"""Pictures of the experiment: the trajectory as tracked, currents measured and predicted."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from twin_plant import Recording

from modelgen.dataset import prepare, preset, read
from modelgen.description import Arm
from modelgen.figures import COLOURS, figure, svg
from modelgen.functions import Options
from modelgen.identification import Validation, identify

Array = NDArray[np.float64]
PERIOD = 80.0  # s


def tracking(t: Array, wanted: Array, recording: Recording) -> str:
    """SVG: set-points and recorded increments of one period, and what is between them."""
    made, axes = figure(3, 2, (8.0, 5.0))
    rows = recording.t < PERIOD - 1e-9
    for k in range(3):
        left, right = axes[k]
        left.plot(t, wanted[:, k], color=COLOURS[0], label="set-point")
        left.plot(recording.t[rows], recording.counts[rows, k], color=COLOURS[1], lw=0.8, label="recorded")
        right.plot(recording.t[rows], recording.counts[rows, k] - wanted[:-1, k], color=COLOURS[1], lw=0.8)
        left.set_ylabel(f"motor {k + 1} [inc]")
        right.set_ylabel("error [inc]")
    made.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=2)
    for axis in axes[2]:
        axis.set_xlabel("t [s]")
    return svg(made)


def predictions(arm: Arm, train: Path, test: Path, mapping: Path) -> dict[str, Validation]:
    """Currents of the test record with and without the drives' dynamics, processed as in the paper."""
    records = [read(str(path), arm, mapping=mapping) for path in (train, test)]
    settings = preset("paper", 1 / records[0].step)
    a, b = (prepare(r, settings) for r in records)
    result = {}
    for name, options in (("without", Options(without=frozenset({"effects"}))), ("with", Options())):
        found = identify([a], arm, options, test=[b]).test
        assert found is not None
        result[name] = found
    return result


def comparison(found: dict[str, Validation]) -> str:
    """SVG: the measured current, and the predicted one without and with the drives' dynamics."""
    made, axes = figure(3, 1, (8.0, 6.0))
    for k in range(3):
        axis, both = axes[k, 0], found["with"]
        rows = both.t < both.t[0] + PERIOD
        axis.plot(both.t[rows], both.measured[rows, k], color="#aaaaaa", lw=0.8, label="measured")
        for name, colour, style in (("without", COLOURS[0], "--"), ("with", "#c02020", "-")):
            line = found[name].predicted[rows, k]
            axis.plot(both.t[rows], line, style, color=colour, label=f"{name} the drives' dynamics")
        axis.set_ylabel(f"current {k + 1} [A]")
    made.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    axes[2, 0].set_xlabel("t [s]")
    return svg(made)
