"""Parameters from logs: regression, uncertainty, validation."""

from modelgen.identification.identify import METHODS, Estimate, Identification, Validation, identify, to_json
from modelgen.identification.regression import Regression, Solution, Triangle
from modelgen.identification.streamed import identify_streamed

__all__ = [
    "METHODS",
    "Estimate",
    "Identification",
    "Regression",
    "Solution",
    "Triangle",
    "Validation",
    "identify",
    "identify_streamed",
    "to_json",
]
