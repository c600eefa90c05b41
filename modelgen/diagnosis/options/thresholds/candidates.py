"""Thresholds of the candidates: what may be asked, and which values an effect may have."""

from __future__ import annotations

from dataclasses import dataclass

from modelgen.diagnosis.options.thresholds.sources import GUARD, JUDGED, SIMULATED
from modelgen.thresholds import Group, entry


@dataclass(frozen=True)
class CandidateThresholds(Group):
    """What decides which candidates are tried, and how far."""

    max_record_disagreement: float = entry(
        3.0,
        "1",
        "Two records are refused as of different arms where one model of both leaves so many times more.",
        GUARD,
    )
    min_record_disagreement: float = entry(
        0.05,
        "of the RMS effort",
        "They are not refused where one model of both leaves less than this.",
        GUARD,
    )
    min_own_share: float = entry(
        1e-4,
        "of a column",
        "An effect that is asked for is refused where the model absorbs all but this of its columns.",
        "far above rounding, far below what a record could show",
    )
    max_log_begin: float = entry(
        1.0, "s", "A part of a log that begins later does not show drives that are still cold.", JUDGED
    )
    min_refined_delta_bic: float = entry(
        4.0,
        "delta BIC",
        "The values of a candidate with less evidence are not refined.",
        "below what names a cause",
    )
    certain_delta_bic: float = entry(
        10.0,
        "delta BIC",
        "A gap is preferred to the elastic joint at its place where its evidence is more by this.",
        "Kass and Raftery (1995): very strong",
    )
    scanned_waves: int = entry(
        4, "waves", "A search for a ripple begins at so many peaks of the periodogram.", "computing time"
    )
    min_wave_rows: int = entry(20, "rows", "With fewer moving rows no ripple is looked for.", GUARD)
    slow_rows_share: float = entry(
        0.1,
        "of the rows",
        "Only waves that pass slower than the cut-off in this share of the rows are looked for.",
        JUDGED,
    )
    wave_search_price: float = entry(
        3.0, "parameters", "A search over all wave numbers of a ripple costs as much as so many.", SIMULATED
    )
    compliant_share: tuple[float, ...] = entry(
        (0.5, 2.0),
        "of what was simulated",
        "Between these an elastic joint or play must be found, or it is none.",
        SIMULATED,
    )
