"""Parameters from logs: regression, uncertainty, validation."""

from modelgen.identification.identify import METHODS, Instruments, identify
from modelgen.identification.objects import Estimate, Identification, Validation
from modelgen.identification.output import to_json
from modelgen.identification.streamed import identify_streamed
from modelgen.identification.summary import verdict
from modelgen.regression.least_squares import Regression, Solution, Triangle

__all__ = [
    "METHODS",
    "Estimate",
    "Identification",
    "Instruments",
    "Regression",
    "Solution",
    "Triangle",
    "Validation",
    "identify",
    "identify_streamed",
    "to_json",
    "verdict",
]
