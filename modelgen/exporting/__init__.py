"""Arms to the formats of simulators: MJCF and URDF."""

from modelgen.exporting.account import Row
from modelgen.exporting.exporter import FORMATS, Exported, check_file, export_model, format_of

__all__ = ["FORMATS", "Exported", "Row", "check_file", "export_model", "format_of"]
