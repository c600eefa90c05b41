"""Thresholds of the adequacy: lack of fit, functions of no law, causes that nothing tells apart."""

from __future__ import annotations

from dataclasses import dataclass

from modelgen.diagnosis.options.thresholds.sources import JUDGED, OTHERS, SIMULATED, STRANGERS
from modelgen.thresholds import Group, entry


@dataclass(frozen=True)
class AdequacyThresholds(Group):
    """What decides whether causes explain what repeats, and whether they merely resemble something else."""

    lack_of_fit_significance: float = entry(
        1e-3, "probability", "Chance of a false alarm of the tests of one kind, all joints together.", JUDGED
    )
    parts_of_period: int = entry(
        16,
        "parts",
        "Lack of fit is tested in as many parts of the period, and in those halfway between.",
        "short enough for a contact or a hard spot",
    )
    min_part_rows: float = entry(
        2.0, "independent rows", "A part with fewer is not tested.", "the least that a variance follows from"
    )
    min_phase_rows: float = entry(
        5.0, "independent rows", "As many phases count at least in the test of all rows.", JUDGED
    )
    min_scatter_rows: float = entry(
        10.0, "independent rows", "With fewer rows that differ between periods nothing is tested.", JUDGED
    )
    null_share: float = entry(
        1.0 - 0.01 / 2.0,
        "of complete models",
        "So many stay below the threshold of either test, and below the evidence of a function of no law.",
        "240 simulated arms with nothing hidden",
    )
    bend_lengths: tuple[float, ...] = entry(
        (0.2, 0.5), "of the range", "Lengths over which the functions of no law bend.", SIMULATED
    )
    spot_length: float = entry(
        0.06,
        "of the range",
        "Functions of one joint's position bend over this length, for hard spots.",
        SIMULATED,
    )
    slow_rows_share: float = entry(
        0.1,
        "of the rows",
        "Without so many, at which its joint is slowest, an elastic joint or play must keep its evidence.",
        STRANGERS,
    )
    max_alias_angle: float = entry(
        1e-6, "rad", "Effects whose columns span spaces at a smaller principal angle are aliases.", "rounding"
    )
    min_absorbed_share: float = entry(
        1e-6,
        "of a column",
        "A column of which the model leaves less is absorbed by its parameters.",
        "rounding",
    )
    max_behind_refused: float = entry(
        15.0,
        "delta BIC",
        "A cause is a suspect where a refused candidate that could be there instead is ahead by more.",
        STRANGERS,
    )
    max_apart_ahead: float = entry(
        15.0,
        "delta BIC",
        "A law that acts on several joints is outdone by itself with a size of its own at every one, if that "
        "is ahead by more; what some records have, by itself with a size of its own in each.",
        STRANGERS,
    )
    max_pace_share: float = entry(
        0.05,
        "of its evidence",
        "A delay is outdone by itself with a size for slow and for fast motion, if that is ahead by more.",
        "filters of 20 Hz on a log of 500 Hz, 1 %; arms on a base that shakes, 18 % at least",
    )
    min_claimed_deviations: float = entry(
        3.0,
        "standard deviations",
        "What an effect claims, as a payload its mass or an elastic joint its compliance, must be above zero "
        "by so many.",
        STRANGERS,
    )
    min_stable_probability: float = entry(
        0.01, "probability", "A cause is reported as stable where records agree on its size (Wald).", JUDGED
    )
    min_explained_share: float = entry(
        0.8,
        "of what is not noise",
        "Causes are suspects where those at a joint explain less of what is missing there together, at the "
        "frequencies at which they act.",
        OTHERS,
    )
    min_clear_evidence: float = entry(
        10.0,
        "delta BIC",
        "A function of no law that is ahead of a joint's causes outdoes them; where nothing repeats, and "
        "noise is not known, one that is ahead by more.",
        "very strong evidence (Kass and Raftery 1995)",
    )
    min_evidence_in_noise: float = entry(
        40.0,
        "delta BIC",
        "Where nothing repeats, what a function of no law explains beside the causes with more is not noise.",
        "in noise of unknown colour functions beside complete models have 37 once in 200",
    )
    usual_null_share: float = entry(
        0.9,
        "of complete models",
        "What is left of a joint counts as more than noise where it repeats more than of so many.",
        "240 simulated arms with nothing hidden",
    )
    max_further_terms_share: float = entry(
        0.5,
        "of its evidence",
        "A law that is the first terms of a series owns what further ones explain where they have less.",
        OTHERS,
    )
    max_counts_ratio: float = entry(
        1.25,
        "1",
        "A free motion lacks nothing where residuals are at most so many times what encoder counts leave.",
        SIMULATED,
    )
