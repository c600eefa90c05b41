"""Thresholds of the next experiment."""

from __future__ import annotations

from dataclasses import dataclass

from modelgen.diagnosis.options.thresholds.sources import DESIGN, JUDGED
from modelgen.thresholds import Group, entry


@dataclass(frozen=True)
class ExperimentThresholds(Group):
    """What decides about the experiment that is proposed."""

    usual_period: float = entry(
        10.0, "s", "A trajectory has this period where the records have none.", DESIGN
    )
    period_range: tuple[float, ...] = entry(
        (4.0, 12.0), "s", "A trajectory's period is that of the records, if it lies between these.", DESIGN
    )
    harmonics: int = entry(
        5, "harmonics", "A trajectory is a Fourier series of so many.", "Swevers et al. (1997)"
    )
    min_samples_per_row: int = entry(
        2, "samples", "A slow motion is tried with at least so many samples for each row.", "computing time"
    )
    bench_duration: float = entry(30.0, "s", "A motion of one joint on the bench lasts so long.", DESIGN)
    bench_speeds: tuple[float, ...] = entry(
        (0.02, 0.05, 0.1, 0.2, 0.5, 0.9),
        "of the speed limit",
        "A bench test at constant speeds has these.",
        DESIGN,
    )
    bench_range_share: float = entry(0.95, "of the range", "Bench tests stay within this.", DESIGN)
    reversal_amplitude: float = entry(
        0.05, "of the range", "Slow reversals on the bench have this amplitude.", DESIGN
    )
    reversal_speed: float = entry(
        0.05, "of the speed limit", "Slow reversals on the bench have this peak speed.", DESIGN
    )
    max_members: int = entry(
        4, "causes", "A trajectory is looked for that separates so many causes at most.", "computing time"
    )
    periods: int = entry(3, "periods", "Evidence of a trajectory is that of so many.", DESIGN)
    limit_margin: float = entry(0.01, "of every limit", "A trajectory keeps this far from limits.", DESIGN)
    other_values: tuple[float, ...] = entry(
        (0.5, 0.7, 1.4, 2.0),
        "of the value found",
        "A rival may have these values of its nonlinear parameter as well.",
        JUDGED,
    )
    min_left_share: float = entry(
        1e-6, "of a column", "A cause of which another one leaves less is contained in it.", "rounding"
    )
