"""How likely the values of a cause are before any record: by how much descriptions usually are wrong.

Several errors of a description, and what a mechanism has besides, look alike where each may have any value.
A value is charged as a Cauchy distribution does: hardly anything up to its scale, and slowly more beyond
(Gelman, Jakulin, Pittau and Su 2008), so that evidence still prevails where there is much of it. Of an
effect that is tried in several forms each form has its share of the effect's prior.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from modelgen.description import Arm
from modelgen.diagnosis.candidates.candidate import Candidate


def prior_penalty(candidate: Candidate, values: Mapping[str, float], arm: Arm) -> float:
    """Price of the candidate's values and of its other forms, in delta BIC."""
    scales = candidate.definition.usual(arm, candidate.joint)
    charged = sum(math.log1p((values[name] / scale) ** 2) for name, scale in scales.items() if name in values)
    return 2.0 * (charged + math.log(candidate.forms))


def place_penalty(candidate: Candidate) -> float:
    """Price of the effect's other places, in the odds against a candidate of another effect.

    No effect is likelier than another before any record: one that may be at every joint is as likely at each
    as its share. Whether anything is there at all is asked of the evidence alone.
    """
    return 2.0 * math.log(candidate.places)


def beyond_plausible(candidate: Candidate, values: Mapping[str, float], arm: Arm) -> bool:
    """Whether someone would have seen it, so that the records must be about something else."""
    times, least = candidate.definition.overlooked
    scales = candidate.definition.usual(arm, candidate.joint)
    return any(abs(values.get(name, 0.0)) > max(times * scale, least) for name, scale in scales.items())
