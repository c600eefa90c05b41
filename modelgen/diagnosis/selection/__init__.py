"""Forward selection, exchange and backward elimination of causes."""

from modelgen.diagnosis.selection.cause import Cause, Selection, together, with_trials
from modelgen.diagnosis.selection.compliance import alternatives, best_beside
from modelgen.diagnosis.selection.deviations import Spread, covariance_of, deviations, unseparated
from modelgen.diagnosis.selection.elastic_fit import smooth
from modelgen.diagnosis.selection.hidden_weight import (
    beside_hidden_weight,
    explained_by_hidden_weight,
    left_beside_hidden_weight,
)
from modelgen.diagnosis.selection.history import (
    COARSE,
    EXCHANGED,
    SUPERFLUOUS,
    SUSPECT,
    History,
    Ranked,
)
from modelgen.diagnosis.selection.marginality import lets_vary
from modelgen.diagnosis.selection.pairs import doubtful_joints, paired, with_pair, with_rival
from modelgen.diagnosis.selection.refit_elastic import effort_rates, refit_elastic
from modelgen.diagnosis.selection.stepwise import Report, forward_selection, needed_evidence, threshold

__all__ = [
    "COARSE",
    "EXCHANGED",
    "SUPERFLUOUS",
    "SUSPECT",
    "Cause",
    "History",
    "Ranked",
    "Report",
    "Selection",
    "Spread",
    "alternatives",
    "beside_hidden_weight",
    "best_beside",
    "covariance_of",
    "deviations",
    "doubtful_joints",
    "effort_rates",
    "explained_by_hidden_weight",
    "forward_selection",
    "left_beside_hidden_weight",
    "lets_vary",
    "needed_evidence",
    "paired",
    "refit_elastic",
    "smooth",
    "threshold",
    "together",
    "unseparated",
    "with_pair",
    "with_rival",
    "with_trials",
]
