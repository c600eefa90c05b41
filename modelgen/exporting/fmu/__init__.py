"""FMU: an arm as a unit for co-simulation and model exchange after FMI 2.0 or 3.0, with its C inside."""

from modelgen.exporting.fmu.fmi2 import FMI2
from modelgen.exporting.fmu.fmi3 import FMI3
from modelgen.exporting.fmu.unit import export_fmu

STANDARDS = {standard.version: standard for standard in (FMI2, FMI3)}

__all__ = ["FMI2", "STANDARDS", "export_fmu"]
