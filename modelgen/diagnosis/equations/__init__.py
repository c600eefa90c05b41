"""The equations y = X b + e of all training records, as wide a band as the encoders allow."""

from modelgen.diagnosis.equations.band import Band, bands, settled_rows
from modelgen.diagnosis.equations.checks import check_efforts, columns_of_effects, weights_of_efforts
from modelgen.diagnosis.equations.drive_inertia import described_by, hidden_inertias
from modelgen.diagnosis.equations.equations import Equations
from modelgen.diagnosis.equations.free_motion import released
from modelgen.diagnosis.equations.position_errors import (
    feigned,
    harmless,
    left_by_reading,
    repeating_errors,
    with_errors,
)
from modelgen.diagnosis.equations.prior import NominalPrior, Unknowns, estimated, held
from modelgen.diagnosis.equations.rows import Rows, rows_of, turning
from modelgen.diagnosis.equations.study import Study, settings_for, study_of

__all__ = [
    "Band",
    "Equations",
    "NominalPrior",
    "Rows",
    "Study",
    "Unknowns",
    "bands",
    "check_efforts",
    "columns_of_effects",
    "described_by",
    "estimated",
    "feigned",
    "harmless",
    "held",
    "hidden_inertias",
    "left_by_reading",
    "released",
    "repeating_errors",
    "rows_of",
    "settings_for",
    "settled_rows",
    "study_of",
    "turning",
    "weights_of_efforts",
    "with_errors",
]
