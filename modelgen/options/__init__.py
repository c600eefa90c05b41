"""The options of commands and functions: each is written once, with its default and its meaning."""

from modelgen.options.calibration import CalibrationOptions
from modelgen.options.diagnosis import DiagnosisOptions
from modelgen.options.excitation import COORDINATES, CRITERIA, Box, ExcitationOptions, box
from modelgen.options.field import Option, changed, option, options_of, words_of
from modelgen.options.generation import GenerationOptions
from modelgen.options.identification import IdentificationOptions
from modelgen.options.model import GAINS, PARTS, ModelOptions
from modelgen.options.simulation import RefinementOptions, SimulationOptions

__all__ = [
    "COORDINATES",
    "CRITERIA",
    "GAINS",
    "PARTS",
    "Box",
    "CalibrationOptions",
    "DiagnosisOptions",
    "ExcitationOptions",
    "GenerationOptions",
    "IdentificationOptions",
    "ModelOptions",
    "Option",
    "RefinementOptions",
    "SimulationOptions",
    "box",
    "changed",
    "option",
    "options_of",
    "words_of",
]
