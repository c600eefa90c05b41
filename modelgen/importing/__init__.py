"""Robots of other formats to arms: URDF and MJCF."""

from modelgen.importing.importer import Imported, import_model

__all__ = ["Imported", "import_model"]
