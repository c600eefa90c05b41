"""Columns of a log on its uniform time axis."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation

from modelgen.dataset.objects import Uneven
from modelgen.dataset.processing.resampling import efforts_resampled, smooth_resampled
from modelgen.dataset.processing.timing import Axis
from modelgen.dataset.reading.sources import Source
from modelgen.numeric import Array


@dataclass(frozen=True)
class OnAxis:
    """Columns by name, moved to the uniform axis."""

    source: Source
    columns: dict[str, Array]
    axis: Axis
    t: Array

    def smooth(self, names: Sequence[str | None]) -> Array:
        """Continuous signals (M, n) at the times of the axis, zero where there is none."""
        table = self._table(names)
        if self.axis.method == "none":
            return table
        return smooth_resampled(self.columns["t"], table, self.t, self.axis.step, self.axis.method)

    def efforts(self, names: Sequence[str | None]) -> tuple[Array, float]:
        """Efforts on the axis, and the time by which their samples lie after the stamps."""
        table, hold = self._table(names), self.source.hold
        half = 0.5 * self.axis.step
        if self.axis.method == "none":
            later = {"following": half, "previous": -half, "instant": 0.0}
            return table, later[hold] if isinstance(hold, str) else hold
        return efforts_resampled(self.columns["t"], table, self.t, self.axis.step, self.axis.method, hold)

    def touched(
        self, names: Sequence[str | None], flags: Mapping[str, NDArray[np.bool_]]
    ) -> NDArray[np.bool_] | None:
        """Samples (M, n) of which a flagged reading has a part, at whatever instant it was read; None where
        no reading is. flags: (N,), by the names of some columns.
        """
        if not flags:
            return None
        found = np.zeros((len(self.t), len(names)), dtype=bool)
        for k, name in enumerate(names):
            if name is not None and name in flags:
                beside = binary_dilation(flags[name], iterations=1)
                even = self.axis.method == "none"
                found[:, k] = beside if even else np.interp(self.t, self.columns["t"], beside) > 0.0
        return found

    def uneven(self, names: Sequence[str | None]) -> Uneven | None:
        """Efforts at their stamps, where those are not the axis."""
        if self.axis.method == "none":
            return None
        return Uneven(self.columns["t"], self._table(names), self.axis.method)

    def _table(self, names: Sequence[str | None]) -> Array:
        zero = np.zeros_like(self.columns["t"])
        # Columns in order in memory: what follows goes through them one by one.
        return np.stack([zero if name is None else self.columns[name] for name in names]).T
