"""Every effect, place and form that could be there besides, each fitted alone."""

from modelgen.diagnosis.candidates.candidate import (
    Candidate,
    Place,
    Values,
    at_ends,
    at_links,
    at_motor,
    candidates,
    cold,
    without_rests,
)
from modelgen.diagnosis.candidates.columns import (
    candidate_columns,
    columns_at_rows,
    of_part,
    slopes,
    unchanging,
)
from modelgen.diagnosis.candidates.fitted import (
    FittedCandidate,
    beside,
    beyond_bounds,
    named,
    sensible,
    system_of,
    with_causes,
)
from modelgen.diagnosis.candidates.pool import fit_pool
from modelgen.diagnosis.candidates.prior_odds import place_penalty, prior_penalty
from modelgen.diagnosis.candidates.requested import asked, check_one_arm
from modelgen.diagnosis.candidates.search import Columns, Search, ahead

__all__ = [
    "Candidate",
    "Columns",
    "FittedCandidate",
    "Place",
    "Search",
    "Values",
    "ahead",
    "asked",
    "at_ends",
    "at_links",
    "at_motor",
    "beside",
    "beyond_bounds",
    "candidate_columns",
    "candidates",
    "check_one_arm",
    "cold",
    "columns_at_rows",
    "fit_pool",
    "named",
    "of_part",
    "place_penalty",
    "prior_penalty",
    "sensible",
    "slopes",
    "system_of",
    "unchanging",
    "with_causes",
    "without_rests",
]
