"""Is what is left explained: lack of fit, smooth functions, stand-ins, causes that cannot be told apart."""

from modelgen.diagnosis.adequacy.checks import Examined, confirmed, examined
from modelgen.diagnosis.adequacy.distinguishable import aliases, without_indistinguishable
from modelgen.diagnosis.adequacy.lack_of_fit import LackOfFit, lack_of_fit, place
from modelgen.diagnosis.adequacy.smooth_functions import smooth_functions
from modelgen.diagnosis.adequacy.stand_ins import Likeness, without_stand_ins
from modelgen.diagnosis.adequacy.verdict import Remains, verdict_of

__all__ = [
    "Examined",
    "LackOfFit",
    "Likeness",
    "Remains",
    "aliases",
    "confirmed",
    "examined",
    "lack_of_fit",
    "place",
    "smooth_functions",
    "verdict_of",
    "without_indistinguishable",
    "without_stand_ins",
]
