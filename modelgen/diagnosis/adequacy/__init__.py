"""Is what is left explained: lack of fit, smooth functions, checks, causes that cannot be distinguished."""

from modelgen.diagnosis.adequacy.checks import Examined, confirmed, examined, significance_of
from modelgen.diagnosis.adequacy.distinguishable import aliases, without_indistinguishable
from modelgen.diagnosis.adequacy.figures_said import possible
from modelgen.diagnosis.adequacy.lack_of_fit import LackOfFit, lack_of_fit, place
from modelgen.diagnosis.adequacy.log_delay import instant_beside_elastic, instant_shown
from modelgen.diagnosis.adequacy.smooth_functions import Likeness
from modelgen.diagnosis.adequacy.verdict import Remains, verdict_of
from modelgen.diagnosis.adequacy.what_is_left import most_like

__all__ = [
    "Examined",
    "LackOfFit",
    "Likeness",
    "Remains",
    "aliases",
    "confirmed",
    "examined",
    "instant_beside_elastic",
    "instant_shown",
    "lack_of_fit",
    "most_like",
    "place",
    "possible",
    "significance_of",
    "verdict_of",
    "without_indistinguishable",
]
