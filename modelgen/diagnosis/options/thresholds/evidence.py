"""Thresholds of the evidence: noise, whitening, instruments."""

from __future__ import annotations

from dataclasses import dataclass

from modelgen.diagnosis.options.thresholds.sources import GUARD, JUDGED, NULLS, SIMULATED
from modelgen.thresholds import Group, entry


@dataclass(frozen=True)
class EvidenceThresholds(Group):
    """What decides how much columns are said to explain."""

    whitening_order: int = entry(
        12,
        "rows",
        "Autoregressive models of this order make residuals white.",
        "Ljung (1999, chapter 16): beyond it residuals of simulated arms stay white",
    )
    min_rows_per_lag: int = entry(
        3, "1", "A record needs so many times the order in rows, or it is refused as too short.", GUARD
    )
    min_fitted_rows_per_lag: int = entry(
        4, "1", "With fewer rows than so many times the order residuals are not made white.", GUARD
    )
    max_lag_share: float = entry(
        0.25,
        "of the record",
        "A record's autocorrelation counts up to lags of this share of it.",
        "Box and Jenkins (1976)",
    )
    autocorrelation_lags: int = entry(
        80,
        "rows",
        "The noise's autocorrelation counts up to this lag.",
        "about two seconds of the usual band; tapered (Newey and West 1987)",
    )
    min_noise_rows: int = entry(
        300,
        "rows",
        "Noise is separated from what repeats where at least so many rows show what differs.",
        JUDGED,
    )
    unknown_noise_price: float = entry(
        1.5,
        "1",
        "Where the noise's colour is not known, evidence counts as if divided by this.",
        NULLS,
    )
    min_equations_per_instrument: float = entry(
        10.0, "1", "Instruments are used where there are more equations for each unknown.", JUDGED
    )
    endogeneity_significance: float = entry(
        1e-4,
        "probability",
        "The regressor counts as correlated with the residuals at this level (Durbin, Wu and Hausman).",
        "Hausman (1978); " + SIMULATED,
    )

    @property
    def min_rows(self) -> int:
        """Rows that a record needs to be asked."""
        return self.min_rows_per_lag * self.whitening_order
