"""Thresholds of the equations: bands, what records must hold, errors of positions, nominal links, free
motions.
"""

from __future__ import annotations

from dataclasses import dataclass

from modelgen.diagnosis.options.thresholds.sources import GUARD, JUDGED, MEASURED, SIMULATED
from modelgen.thresholds import Group, entry


@dataclass(frozen=True)
class EquationThresholds(Group):
    """What decides about the equations, before any candidate is asked."""

    max_cutoff: float = entry(
        18.0,
        "Hz",
        "Effort and regressor are filtered with this cut-off where the rate allows it.",
        "friction and play act far above the frequencies of the motion; " + MEASURED,
    )
    max_free_cutoff: float = entry(
        10.0,
        "Hz",
        "Free motions are filtered with this cut-off: their noise is all in the positions.",
        SIMULATED,
    )
    samples_per_cutoff_period: float = entry(
        12.0, "samples", "The cut-off is so low that its period holds at least so many samples.", JUDGED
    )
    narrow_cutoff_over_bandwidth: float = entry(
        10.0,
        "1",
        "Where position errors spoil the usual band, the cut-off is so many times the motion's bandwidth.",
        SIMULATED,
    )
    lost_band_percent: float = entry(
        5.0,
        "% of the RMSE",
        "Where position errors alone could gain more, the usual band is not asked at all.",
        SIMULATED,
    )
    min_moving_share: float = entry(
        0.02, "of the rows", "A joint that moves in a smaller share of the rows counts as resting.", GUARD
    )
    min_equations_per_unknown: float = entry(
        3.0, "1", "Records with fewer equations for each parameter of the model are refused.", GUARD
    )
    max_condition_number: float = entry(
        1e3,
        "1",
        "A combination of parameters shows in the motion if the largest singular value of the regressor, "
        "columns of unit norm, is at most so many times its own.",
        "an order of magnitude above what excitation by `modelgen excite` reaches (Gautier and Khalil 1992)",
    )
    max_unseparated_share: float = entry(
        0.1,
        "of the parameters",
        "A motion in which a larger share of the combinations of parameters does not show is refused.",
        GUARD,
    )
    max_unexplained_effort: float = entry(
        0.95,
        "of the RMS effort",
        "A record of whose effort the model, fitted to it alone, leaves more at every joint is refused.",
        GUARD,
    )
    max_turned_share: float = entry(
        0.5,
        "of the error",
        "A record is refused whose efforts, turned round, leave less of this at a joint with the parameters "
        "of the other records.",
        JUDGED,
    )
    max_driving_friction: float = entry(
        0.2,
        "of the power",
        "Records in which friction would give a joint a larger share of its power are refused.",
        GUARD,
    )
    min_position_steps: int = entry(
        20, "steps", "The resolution of positions is read off a log that has at least so many steps.", JUDGED
    )
    near_step_ratio: float = entry(
        1.5, "of the smallest", "Steps below this are single counts, and their mean is the count.", JUDGED
    )
    small_step_counts: float = entry(
        10.0, "counts", "Steps below this are small: jitter of the mean adds up over longer ones.", JUDGED
    )
    whole_steps_share: float = entry(
        0.95,
        "of the small steps",
        "Positions are stepped where so many of their small steps are whole counts.",
        JUDGED,
    )
    max_count_deviation: float = entry(
        0.05,
        "counts",
        "A step counts as whole that is this near to a whole number of counts.",
        JUDGED,
    )
    max_rounding_error: float = entry(
        1.5,
        "1",
        "Rounding is all the error of positions whose third differences exceed those of rounding by less.",
        JUDGED,
    )
    max_repeated_difference: float = entry(
        0.5,
        "counts (RMS)",
        "Readings of two periods that differ by less are rounded alike.",
        "independent errors make 0.41 by the steps alone, motions that differ by a third of a count over 0.5",
    )
    nominal_scatter: float = entry(
        0.3,
        "of the link's natural scale",
        "Nominal mass, first moments and inertia are expected to be off by this much.",
        "typical of drawings without motors and cables; its scatter is estimated besides (Lange et al. 1989)",
    )
    min_nominal_weight: float = entry(
        4.0, "measurements", "The expected scatter of nominal inertials is worth at least so many.", SIMULATED
    )
    rest_noise_deviations: float = entry(
        3.0,
        "standard deviations",
        "In a free motion speeds within so many of their noise count as rest.",
        "leaves about three in a thousand samples of normal noise",
    )
    max_position_cutoff: float = entry(
        0.4,
        "of the rate",
        "A free motion's positions are filtered below this, or as other records are.",
        JUDGED,
    )
    position_cutoff_ratios: tuple[float, ...] = entry(
        (18.0, 9.0),
        "1",
        "Cut-offs of a free motion's positions over the parallel one, the first that the noise allows.",
        "a filter of positions shifts the zero of the speed, where friction changes sides",
    )
    max_noise_over_rest_speed: float = entry(
        2.0,
        "1",
        "The noise allows a cut-off where its speeds stay below so many times those that count as rest.",
        JUDGED,
    )
