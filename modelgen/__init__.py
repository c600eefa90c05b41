"""From a description of an arm to its dynamic model: C99, CasADi and NumPy.

What the command line can do a function can do: docs/python.md shows the way from a log to generated code. A
name is imported when it is asked for.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from modelgen.errors import InputError
from modelgen.version import __version__

if TYPE_CHECKING:
    from modelgen.api.calibration import Calibration, calibrate
    from modelgen.api.description import load_arms
    from modelgen.api.diagnosis import Diagnosis, diagnose
    from modelgen.api.drawing import Drawing, draw
    from modelgen.api.effects import EFFECTS
    from modelgen.api.excitation import Excitation, excite
    from modelgen.api.exporting import ExportedModel, export
    from modelgen.api.generation import Generated, generate
    from modelgen.api.identification import Identification, identify
    from modelgen.api.importing import ImportedRobot, import_robot
    from modelgen.api.inspect import Inspection, inspect_log, read_log
    from modelgen.api.model import Model, build_model
    from modelgen.api.refinement import Refinement, refine
    from modelgen.api.simulation import Simulation, simulate
    from modelgen.dataset import Record
    from modelgen.description import Arm, starter
    from modelgen.options import (
        CalibrationOptions,
        DiagnosisOptions,
        ExcitationOptions,
        GenerationOptions,
        IdentificationOptions,
        ModelOptions,
        RefinementOptions,
        SimulationOptions,
    )

__all__ = [
    "EFFECTS",
    "Arm",
    "Calibration",
    "CalibrationOptions",
    "Diagnosis",
    "DiagnosisOptions",
    "Drawing",
    "Excitation",
    "ExcitationOptions",
    "ExportedModel",
    "Generated",
    "GenerationOptions",
    "Identification",
    "IdentificationOptions",
    "ImportedRobot",
    "InputError",
    "Inspection",
    "Model",
    "ModelOptions",
    "Record",
    "Refinement",
    "RefinementOptions",
    "Simulation",
    "SimulationOptions",
    "__version__",
    "build_model",
    "calibrate",
    "diagnose",
    "draw",
    "excite",
    "export",
    "generate",
    "identify",
    "import_robot",
    "inspect_log",
    "load_arms",
    "read_log",
    "refine",
    "simulate",
    "starter",
]

_HOMES = {
    "modelgen.api.calibration": ("Calibration", "calibrate"),
    "modelgen.api.description": ("load_arms",),
    "modelgen.api.diagnosis": ("Diagnosis", "diagnose"),
    "modelgen.api.drawing": ("Drawing", "draw"),
    "modelgen.api.effects": ("EFFECTS",),
    "modelgen.api.excitation": ("Excitation", "excite"),
    "modelgen.api.exporting": ("ExportedModel", "export"),
    "modelgen.api.generation": ("Generated", "generate"),
    "modelgen.api.identification": ("Identification", "identify"),
    "modelgen.api.importing": ("ImportedRobot", "import_robot"),
    "modelgen.api.inspect": ("Inspection", "inspect_log", "read_log"),
    "modelgen.api.model": ("Model", "build_model"),
    "modelgen.api.refinement": ("Refinement", "refine"),
    "modelgen.api.simulation": ("Simulation", "simulate"),
    "modelgen.dataset": ("Record",),
    "modelgen.description": ("Arm", "starter"),
    "modelgen.options": (
        "CalibrationOptions",
        "DiagnosisOptions",
        "ExcitationOptions",
        "GenerationOptions",
        "IdentificationOptions",
        "ModelOptions",
        "RefinementOptions",
        "SimulationOptions",
    ),
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'modelgen' has no attribute '{name}'")
    value = getattr(import_module(_HOME[name]), name)
    globals()[name] = value  # asked for once
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
