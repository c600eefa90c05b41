"""Thresholds of validation: what a cause must gain on rows that its fit has not seen."""

from __future__ import annotations

from dataclasses import dataclass

from modelgen.diagnosis.options.thresholds.sources import JUDGED, NULLS, SIMULATED
from modelgen.thresholds import Group, entry


@dataclass(frozen=True)
class ValidationThresholds(Group):
    """What decides whether a cause with evidence passes validation. Gains are those of the usual band."""

    min_gain_percent: float = entry(
        1.5, "% of the RMSE", "A cause must promise this gain on unseen rows to be worth naming.", JUDGED
    )
    faint_gain_percent: float = entry(
        3.0,
        "% of the RMSE",
        "With faint evidence a cause must promise this gain: it may be the best of hundreds by chance.",
        NULLS,
    )
    faint_delta_bic: tuple[float, ...] = entry(
        (6.0, 15.0),
        "delta BIC",
        "Evidence over which the gain that is asked falls from `faint_gain_percent` to `min_gain_percent`.",
        NULLS,
    )
    gain_beside_delay_percent: float = entry(
        3.0,
        "% of the RMSE",
        "Friction near rest must promise this gain beside a delay, which acts at reversals too.",
        SIMULATED,
    )
    gain_at_reversals_percent: float = entry(
        5.0,
        "% of the RMSE",
        "What acts at reversals must promise this gain beside another cause that does: its form leaves some.",
        SIMULATED,
    )
    min_measured_share: float = entry(
        0.2,
        "of the expected gain",
        "So much of the expected gain must be measured, unless the records agree on the cause's size.",
        SIMULATED,
    )
    min_agreement: float = entry(
        1e-4,
        "probability",
        "Records contradict a cause where noise alone makes estimates differ as much less often (Wald).",
        SIMULATED,
    )
    max_rise: float = entry(
        0.01,
        "of the squares",
        "A cause may make the mean of all joints' squares worse by this.",
        SIMULATED,
    )
    min_power_share: float = entry(
        0.1,
        "of the power",
        "A record with less of play's power than another one does not show it: halves of all are tried.",
        SIMULATED,
    )
    position_error_factor: float = entry(
        1.5,
        "1",
        "A gain must exceed what a draw of position errors could feign by this factor.",
        "the errors that are there may by chance leave more than the draw; " + SIMULATED,
    )
    min_instrument_deviations: float = entry(
        6.0,
        "standard deviations",
        "An estimate by instruments further from zero than this shows a cause in spite of position errors.",
        SIMULATED,
    )
    form_error: float = entry(
        0.05,
        "of the power",
        "A law leaves this share of what it explains to others, since no arm follows it exactly.",
        SIMULATED,
    )
    elastic_form_error: float = entry(
        0.1,
        "of the power",
        "Elastic joints and play, which shake all links, leave this share.",
        SIMULATED,
    )
    max_records_one_by_one: int = entry(
        4,
        "records",
        "Up to so many records are held out one by one; of more every other one is.",
        "computing time",
    )
