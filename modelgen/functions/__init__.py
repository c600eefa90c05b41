"""The functions of an arm, ready for any backend."""

from modelgen.functions.build import build_model
from modelgen.functions.nominal import grouped, nominal_base, nominal_standard
from modelgen.functions.objects import (
    STATUS_INPUT,
    STATUS_PIVOT,
    STATUS_STROKE,
    Argument,
    Function,
    InputRange,
    Model,
    Output,
    SparsityTable,
)
from modelgen.functions.options import EVALUATED, GAINS, PARTS, Options

__all__ = [
    "EVALUATED",
    "GAINS",
    "PARTS",
    "STATUS_INPUT",
    "STATUS_PIVOT",
    "STATUS_STROKE",
    "Argument",
    "Function",
    "InputRange",
    "Model",
    "Options",
    "Output",
    "SparsityTable",
    "build_model",
    "grouped",
    "nominal_base",
    "nominal_standard",
]
