"""Thresholds of the selection: evidence that names a cause, and rivals that could stand for it."""

from __future__ import annotations

from dataclasses import dataclass

from modelgen.diagnosis.options.thresholds.sources import JUDGED, NULLS, SIMULATED
from modelgen.thresholds import Group, entry


@dataclass(frozen=True)
class SelectionThresholds(Group):
    """What decides which candidates become causes."""

    min_delta_bic: float = entry(
        6.0,
        "delta BIC",
        "It takes so much evidence to name a cause.",
        "Kass and Raftery (1995): strong; five of 232 simulated arms with nothing hidden reach it",
    )
    single_parameter_delta_bic: float = entry(
        10.0,
        "delta BIC",
        "It takes this for a cause with one parameter, whose price is low.",
        "by chance one column reaches 6 one time in 10,000 and 10 one time in 100,000",
    )
    fading_delta_bic: float = entry(
        9.0,
        "delta BIC",
        "It takes this for what fades within a record, as warming does: slow drifts look like it.",
        NULLS,
    )
    unknown_noise_delta_bic: float = entry(
        15.0,
        "delta BIC",
        "It takes this where no period repeats, so that the noise's colour is not known.",
        NULLS,
    )
    rival_margin_bic: float = entry(
        15.0,
        "delta BIC",
        "A candidate that passes and is behind by less could stand for the cause.",
        SIMULATED,
    )
    rival_margin_of_evidence: float = entry(
        0.03,
        "of the evidence",
        "Play and elasticity at one joint rival up to this, if that is more: no real gear has either form.",
        SIMULATED,
    )
    max_rival_share: float = entry(
        0.5,
        "of its evidence",
        "A rival that keeps more beside the causes explains something else and stands for none.",
        SIMULATED,
    )
    min_whole_arm_share: float = entry(
        0.7,
        "of the expected gain",
        "A cause of all joints gives way where it promises less than one joint's promises there alone.",
        SIMULATED,
    )
    min_gap_gain_ratio: float = entry(
        1.15,
        "1",
        "A gap is named instead of an elastic joint where it carries so much more to unseen rows.",
        SIMULATED,
    )
    max_sign_deviations: float = entry(
        3.0,
        "standard deviations",
        "A cause leaves whose value, which cannot be negative, is further below zero in the final model.",
        "leaves one in a thousand of normal errors",
    )
    max_refit_growth: float = entry(
        3.0,
        "1",
        "Values stay as they were first found where a refit makes a cause's sum of squares grow beyond this.",
        "what runs on belongs to another law; " + SIMULATED,
    )
    max_causes: int = entry(
        6, "causes", "So many causes are looked for at most, or `max_causes_per_joint`.", JUDGED
    )
    max_causes_per_joint: int = entry(
        2, "causes", "So many are looked for at each joint, if that is more than `max_causes`.", JUDGED
    )
