"""Thresholds of the extended model: what is determined, and what is its drive's."""

from __future__ import annotations

from dataclasses import dataclass

from modelgen.diagnosis.options.thresholds.sources import DESIGN, JUDGED
from modelgen.thresholds import Group, entry


@dataclass(frozen=True)
class ExtendedThresholds(Group):
    """What decides about the values that are reported."""

    min_inertia_share: float = entry(
        0.05,
        "of both inertias",
        "A drive's inertia is split from its link's where each has at least this share.",
        JUDGED,
    )
    max_relative_deviation: float = entry(
        0.5, "of the value", "A searched value with a larger standard deviation is not determined.", JUDGED
    )
    simulated_window: float = entry(
        0.25, "s", "The test record is simulated in windows of this length from measured states.", DESIGN
    )
    max_windows: int = entry(250, "windows", "So many windows are simulated at most.", "computing time")
    bootstrap_blocks: int = entry(
        20, "blocks", "Intervals of gains follow from so many blocks of the test record.", "Kuensch (1989)"
    )
    interval_quantiles: tuple[float, ...] = entry(
        (0.025, 0.975), "probability", "Ends of the interval of a gain.", DESIGN
    )
