"""FMU: an arm as a unit for co-simulation and model exchange after FMI 2.0, with its C inside."""

from modelgen.exporting.fmu.unit import export_fmu

__all__ = ["export_fmu"]
