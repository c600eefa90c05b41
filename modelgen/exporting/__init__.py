"""Arms to the formats of simulators: MJCF, URDF and FMU."""

from modelgen.exporting.account import Row
from modelgen.exporting.exported import Exported
from modelgen.exporting.exporter import FORMATS, check_file, check_format, export_model

__all__ = ["FORMATS", "Exported", "Row", "check_file", "check_format", "export_model"]
