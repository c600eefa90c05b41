"""Thresholds by which a log is refused, and by which its processing is chosen."""

from __future__ import annotations

from dataclasses import dataclass

from modelgen.thresholds import Group, entry

_GUARD = "a guard against mistakes in logs, chosen by judgement"
_CHOICE = "chosen by judgement on the example logs"


@dataclass(frozen=True)
class DatasetThresholds(Group):
    """Thresholds of records: stamps, ranges, cut-offs, periods, rest. See docs/thresholds.md."""

    min_samples: int = entry(20, "samples", "A log with fewer samples is refused.", _GUARD)
    max_gap_periods: float = entry(
        10.0, "sampling periods", "A longer time without a sample is refused as a gap.", _GUARD
    )
    max_pause: float = entry(
        60.0, "s", "A record runs on from one of its clock that ended no longer before.", _CHOICE
    )
    max_jitter: float = entry(
        0.02,
        "sampling periods",
        "Stamps that stay this near to a uniform axis count as uniform, and nothing is resampled.",
        _CHOICE,
    )
    max_spline_jitter: float = entry(
        0.5,
        "sampling periods",
        "Where the time between samples varies by more, a spline would ring: interpolation is monotone.",
        _CHOICE,
    )
    averaging_step: float = entry(
        1.5,
        "sampling periods",
        "A uniform axis with longer steps holds means of the samples between, not interpolated values.",
        _CHOICE,
    )
    slow_sampling_step: float = entry(
        0.5, "s", "A longer step is asked about, unless a mapping file declares the stamps' unit.", _GUARD
    )
    fast_sampling_step: float = entry(
        1e-5, "s", "A shorter step is asked about, unless a mapping file declares the stamps' unit.", _GUARD
    )
    doubled_stamps: float = entry(
        0.05,
        "of the stamps",
        "Where so many equal the one before, stamps are coarser than the samples, which are evenly spaced.",
        _CHOICE,
    )
    even_roughness: float = entry(
        0.5,
        "1",
        "Samples count as evenly spaced where positions are so much smoother than over the stamps.",
        _CHOICE,
    )
    min_refreshes: int = entry(
        60, "readings", "Repeated readings are recognised by so many new ones at least.", _GUARD
    )
    min_repeats: float = entry(
        1.9, "rows", "Of an even clock, a new reading comes after so many rows at least.", _GUARD
    )
    single_refreshes: float = entry(
        0.9, "of the readings", "Readings repeat where so many come one refresh after the last.", _CHOICE
    )
    whole_refreshes: float = entry(
        0.98,
        "of the readings",
        "Readings repeat where more than that come a whole number of refreshes after the last.",
        _CHOICE,
    )
    refresh_over_resolution: float = entry(
        2.5,
        "steps of the resolution",
        "Readings repeat where one moves by more in the median; a slow, coarse encoder moves by one.",
        _CHOICE,
    )
    least_repeats: float = entry(
        1.1, "rows", "Of a clock that is not even, a new reading comes after so many rows at least.", _GUARD
    )
    moves_after_standing: float = entry(
        0.5,
        "of the large changes",
        "Readings repeat where more than that come after the reading stood; less where its steps are finer.",
        "instants that follow no clock, at a mean of two rows, leave 61 % of the changes after a repetition",
    )
    remarked_effort: float = entry(1.1, "of the limit", "A larger effort is remarked on.", _GUARD)
    impossible_effort: float = entry(3.0, "of the limit", "A larger effort is refused.", _GUARD)
    outlying_effort: float = entry(
        20.0,
        "of the 99.9 % quantile",
        "A reading beyond that, and beyond as many times its neighbours, is refused as impossible.",
        _GUARD,
    )
    min_lone_samples: int = entry(
        100, "samples", "Lone readings are looked for in logs of so many at least.", _GUARD
    )
    lone_reading: float = entry(
        20.0,
        "of the 99 % quantile",
        "A reading farther from the cubic through the four beside it is lone, and read as they say.",
        "no position of the example logs has one; an encoder's bit that is read wrongly is larger",
    )
    jump: float = entry(
        6.0,
        "of the 90 % quantile",
        "A position that jumps by so many times its usual steps, and those beside, is refused.",
        "no position of the example logs jumps by 4; an encoder that starts anew does by far more",
    )
    lone_effort: float = entry(
        0.01, "of the range", "An effort that is less far from them stays as it is.", _GUARD
    )
    misread_efforts: float = entry(
        0.05, "of the readings", "Where more are beyond the limit, the unit is asked about.", _GUARD
    )
    milliampere_readings: float = entry(
        0.2, "of the readings", "Where more are beyond the limit, milliamperes are asked about.", _GUARD
    )
    max_range_excess: float = entry(
        0.1, "of the range", "Positions that leave a joint's range by more are refused.", _GUARD
    )
    steady_step: float = entry(
        0.1,
        "rad",
        "Half a turn within one sample is refused, as a sensor's new start, where the median step is less.",
        _GUARD,
    )
    max_shared_samples: int = entry(
        50,
        "samples",
        "A test record with so many consecutive moving samples of a training record is refused as a copy.",
        _GUARD,
    )
    max_rate_difference: float = entry(
        0.02, "1", "Records whose rates differ by more cannot be processed alike and are refused.", _GUARD
    )
    max_instant_std: float = entry(
        0.15,
        "sampling periods",
        "When the efforts were read is not asked of records that tell it less surely; readings do not count "
        "within this of which their joint turns back.",
        "conventions are half a period apart: more than three standard deviations",
    )
    turning_periods: float = entry(
        1.0,
        "sampling periods",
        "Where motions repeat, a diagnosis leaves out efforts so near to an instant at which their joint "
        "turns back: it sticks there, and nobody sees between two readings for how long. Twice that where "
        "efforts are interpolated.",
        "the last reading before a turn and the first one after it",
    )
    instant_tolerance: float = entry(
        0.25,
        "sampling periods",
        "A convention of when efforts were read is what the data say to this, or to three deviations.",
        "half of what lies between two conventions; dry friction shifts what is found by up to 0.2",
    )
    max_noise_share: float = entry(
        1e-3,
        "of the power",
        "The cut-off is as high as leaves noise of the positions this share of the accelerations' power.",
        "keeps the bias of least squares by noise in the regressor small (Gautier 1997)",
    )
    max_speed_noise_share: float = entry(
        1e-4,
        "of the power",
        "The positions' filter is narrower where rounding feigns a larger share of the speeds' power.",
        "dry friction changes sign with the speed: chosen by the coverage of benchmarks/deviations.py",
    )
    cutoff_rounding_share: float = entry(
        3e-4,
        "of the power",
        "The cut-off is as high as lets rounding feign this share of the accelerations' power.",
        "an inertia's share may be a fifth of it; chosen by the coverage of benchmarks/deviations.py",
    )
    max_rounding_share: float = entry(
        1e-2,
        "of the power",
        "Positions are too coarse where rounding feigns a larger share of the accelerations' power.",
        "thirty times what the cut-off allows; chosen by the coverage of benchmarks/deviations.py",
    )
    least_position_cutoff_over_cutoff: float = entry(
        2.0,
        "1",
        "However coarse the positions are, their filter has so many times the cut-off of the parallel one.",
        "loses 0.4 % at the cut-off",
    )
    bandwidth_power: float = entry(
        0.9,
        "of the power",
        "The bandwidth of a motion is the frequency below which this share of the speeds' power lies.",
        _CHOICE,
    )
    cutoff_over_bandwidth: float = entry(
        2.5, "1", "The cut-off is at least so many times the bandwidth of the motion.", _CHOICE
    )
    min_cutoff_periods: float = entry(
        10.0,
        "periods of the cut-off",
        "The cut-off is so high that a record holds so many at least.",
        _CHOICE,
    )
    samples_per_cutoff_period: float = entry(
        25.0, "samples", "The cut-off is so low that its period holds at least so many samples.", _CHOICE
    )
    position_cutoff_over_cutoff: float = entry(
        4.5,
        "1",
        "The positions' filter has so many times the cut-off of the parallel one.",
        "well above the pass band of the parallel filter (Gautier 1997), chosen on the example logs",
    )
    max_position_cutoff: float = entry(
        0.45,
        "of the rate",
        "A positions' filter with a higher cut-off would do nothing and is left out.",
        "just below half the rate, the highest frequency that samples show",
    )
    row_rate_over_cutoff: float = entry(
        2.3,
        "1",
        "Rows are decimated to so many times the parallel cut-off at least.",
        "the pass band fills the rows' band (Gautier 1997)",
    )
    trimmed_cutoff_periods: float = entry(
        1.5,
        "periods of the lowest cut-off",
        "So much is trimmed at both ends of a record, where filters have no past or future.",
        _CHOICE,
    )
    direction_deviations: float = entry(
        2.0,
        "standard deviations",
        "A joint whose speed is within this of zero, by the rounding of its position, moves nobody knows "
        "which way: its samples do not count.",
        "one in 20 of a normal distribution",
    )
    max_acceleration_noise: float = entry(
        0.5,
        "of their power",
        "Accelerations of more noise would bring it into the band of the equations at sharp edges of what is "
        "left out: the weight of samples falls slowly there.",
        _CHOICE,
    )
    rest_speed: float = entry(
        0.01,
        "of its 99 % quantile",
        "A joint's speed below counts as slow.",
        _CHOICE,
    )
    max_readings_at_rest: int = entry(
        5,
        "readings",
        "A joint with no more distinct positions in a record rests, be it shaken.",
        _CHOICE,
    )
    rest_cutoff_periods: float = entry(
        0.25,
        "periods of the cut-off",
        "A joint that stays slow for longer rests; a reversal passes faster.",
        _CHOICE,
    )
    min_rest_time: float = entry(
        5e-3, "s", "A joint that is slow for less does not rest, whatever the cut-off.", _CHOICE
    )
    max_rest_weight: float = entry(
        0.02,
        "of the filter's weight",
        "A row counts as moving where the parallel filter takes less of its weight from samples at rest.",
        _CHOICE,
    )
    short_rest_cutoff_periods: float = entry(
        0.05,
        "periods of the cut-off",
        "Samples of a rest that lasts longer leave effort and columns before the parallel filter.",
        "a shorter rest leaves nothing in what the filter lets pass",
    )
    min_rows: int = entry(
        10, "rows", "A record with fewer rows after filtering and decimation is refused.", _GUARD
    )
    max_period_difference: float = entry(
        2e-3,
        "of the power",
        "Positions repeat after a lag if they differ by less of their power.",
        "calibrated on repeated trajectories of measured arms",
    )
    max_given_period_difference: float = entry(
        0.05,
        "of the power",
        "A period that the user gives is refused where positions differ by more from one to the next.",
        _GUARD,
    )
    min_period_samples: int = entry(4, "samples", "A given period with fewer samples is refused.", _GUARD)


USUAL = DatasetThresholds()
